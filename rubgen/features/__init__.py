"""Features of recorded channels: names with units, windows, and the table of a data set."""
