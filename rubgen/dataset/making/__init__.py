"""A data set is made: the directory claimed, runs simulated and staged, files assembled."""
