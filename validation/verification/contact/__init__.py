"""The integrator and contact against exact solutions."""
