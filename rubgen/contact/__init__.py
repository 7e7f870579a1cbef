"""Unilateral contact of blade tips with the deformed casing surface."""

from rubgen.contact.friction import sliding_friction
from rubgen.contact.geometry import blade_tips, casing_surface, gap_and_foot
from rubgen.contact.lcp import LcpUnsolvedError, solve_complementarity

__all__ = [
    "LcpUnsolvedError",
    "blade_tips",
    "casing_surface",
    "gap_and_foot",
    "sliding_friction",
    "solve_complementarity",
]
