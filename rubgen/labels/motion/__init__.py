"""The class of the motion, and what decides it."""
