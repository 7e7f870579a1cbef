"""Inputs that no user gives on purpose, made from seeds."""
