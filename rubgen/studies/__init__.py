"""Studies of models and data sets: what follows from many runs, or from a model alone."""
