"""Checks of a scenario from its numbers alone, before anything is built."""
