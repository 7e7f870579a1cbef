"""The linear models that the figures compare."""
