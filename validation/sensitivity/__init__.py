"""Sensitivity of labels, impulses and orders to the numbers that a user does not see: steps, modes, nodes, turns."""

from __future__ import annotations
