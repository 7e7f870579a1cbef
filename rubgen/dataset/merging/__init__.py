"""Several data sets become one: checked against each other, copied with new names of runs."""
