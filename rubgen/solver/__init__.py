"""Integration of a spinning system in time, with contact.

What compiles nothing is here; `rubgen.solver.integrate` and `rubgen.solver.stepper` bring the kernels with them.
"""

from rubgen.solver.response import ContactEvents, EnergyBook, Response, Status

__all__ = ["ContactEvents", "EnergyBook", "Response", "Status"]
