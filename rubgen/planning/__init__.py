"""What comes before a data set: what rubgen offers, files to begin with, what a recipe will do and cost."""
