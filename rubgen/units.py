"""Constants of units."""

STANDARD_GRAVITY = 9.80665
"""Standard gravity in m/s2 (ISO 80000-3)."""
