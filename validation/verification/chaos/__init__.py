"""Indicators of chaos on maps, flows and oscillators that are known."""
