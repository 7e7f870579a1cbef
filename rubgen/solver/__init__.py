"""Integration of a spinning system in time, with contact.

`integrate` makes a `Response` of a system through four rooms, each of which imports only those before it: `linear`
(what the linear system says before a run), `scheme` (the steps), `speed` (the start, and how turns follow the speed),
`observers` (what is kept of a run). This file compiles nothing; the rooms bring their kernels with them.
"""

from rubgen.solver.response import ContactEvents, EnergyBalance, Response, Status

__all__ = ["ContactEvents", "EnergyBalance", "Response", "Status"]
