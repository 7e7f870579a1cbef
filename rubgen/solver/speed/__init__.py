"""The start of a run, and its turns at a steady or a changing speed."""
