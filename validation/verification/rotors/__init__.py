"""Rotors, supports and reduction without contact."""
