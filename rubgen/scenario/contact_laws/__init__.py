"""Contact between blades and casing."""
