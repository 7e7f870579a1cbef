"""Unilateral contact of blade tips with the deformed casing surface."""

from rubgen.contact.geometry import blade_tips, casing_surface

__all__ = ["blade_tips", "casing_surface"]
