"""Contact between blades and casing, one file a law of the normal force; `contact_law` registers them."""
