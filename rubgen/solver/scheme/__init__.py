"""The scheme: one system, its state, and the kernels that advance it through a turn."""
