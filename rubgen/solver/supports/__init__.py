"""Forces on the disk centre that no constant matrix holds: the laws in plain numpy and in kernels."""
