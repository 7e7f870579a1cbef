"""The kinds of sensors, one file each."""
