"""Baselines: what simple models score on a data set, by group and, for comparison, with a leak."""
