"""Forces on the disk centre that no constant matrix contains: the laws in plain numpy and in kernels."""
