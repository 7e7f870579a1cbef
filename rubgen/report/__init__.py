"""What people look at of a data set, a run or a machine: figures, and one page."""
