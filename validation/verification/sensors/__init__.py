"""Checks of what sensors feel."""
