"""Tables of a recipe, as users write them."""
