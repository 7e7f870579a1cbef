"""How far clustering, the 0-1 test and the Lyapunov exponent agree on the motion of rubbing runs."""

from __future__ import annotations
