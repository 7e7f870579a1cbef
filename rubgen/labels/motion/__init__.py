"""The class of the motion, and its indicators."""
