"""Data sets in the file formats of other programs, one module for each format."""
