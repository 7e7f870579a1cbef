"""Virtual machines of a recipe: the keys that may vary, and how one machine is drawn."""
