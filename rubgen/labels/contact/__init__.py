"""Labels of contact: how much and where blades touch."""
