"""A run as Rerun entities for the viewer."""
