"""Virtual sensors in recipes: their kinds, and sets of them."""
