"""Observers of a run. They record it and never change its motion."""
