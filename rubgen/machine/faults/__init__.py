"""Faults of a machine, one file a fault; `registry` lists them."""
