"""Integration of a spinning system in time, with contact.

`integrate` makes the `Response` of a system with five rooms. Each imports only the rooms before it: `linear` (the
linear system before a run), `supports` (forces on the disk centre that no constant matrix contains), `scheme` (the
steps), `speed` (the start, and the turns at a steady or changing speed), `observers` (what a response records of a
run). This file compiles nothing; the rooms import their kernels.
"""

from rubgen.solver.response import ContactEvents, EnergyBalance, Response, Status

__all__ = ["ContactEvents", "EnergyBalance", "Response", "Status"]
