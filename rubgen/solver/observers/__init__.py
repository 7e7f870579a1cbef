"""What is kept of a run while it goes: nothing here changes its motion."""
