"""Runs to look at: Rerun recordings and figures."""
