"""Vectors and matrices in blocks, for kernels: below all physics.

A step of the scheme is some hundred short sums. Numba keeps them neither in vector registers nor fused, which makes a
step three times as long; so the sums are written in LLVM's vector type:

- `vector_kernels`: rows of eight numbers in registers, and how a function stands twice, plain and in vector code;
- `lanes_kernels`: sums of products along lines of rows, the inner loops of a step;
- `block_kernels`: products with matrices in blocks;
- `harmonic_kernels`: from harmonics over the blades to the tips and back;
- `blocks`: finds the blocks of given matrices and stores the matrices for the kernels.
"""
