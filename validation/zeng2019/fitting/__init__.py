"""The search for what the paper does not publish."""
