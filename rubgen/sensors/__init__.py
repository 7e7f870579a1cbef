"""Virtual sensors as users describe them: their kinds, and sets of them."""
