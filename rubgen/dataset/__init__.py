"""Data sets: made from a recipe, proven by a manifest, described by a card, checked, opened."""
