"""How much and where blades touch."""
