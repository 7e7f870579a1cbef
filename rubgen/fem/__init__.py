"""Finite elements: the full model of blisk and casing."""
