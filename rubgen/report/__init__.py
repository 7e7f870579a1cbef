"""Figures of a data set, a run or a machine, and one page."""
