"""What the viewer shows of a run, as Rerun entities."""
