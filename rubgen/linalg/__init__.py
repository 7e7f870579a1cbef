"""Vectors and matrices in blocks, for kernels: below all physics.

A step of the scheme is some hundred short sums. Numba neither fuses them nor keeps them in vector registers, which
makes a step three times as long. The sums are therefore written in LLVM's vector type:

- `vector_kernels`: rows of eight numbers in registers; each function exists twice, plain and in vector code;
- `lanes_kernels`: sums of products along lines of rows, the inner loops of a step;
- `block_kernels`: products with matrices in blocks;
- `harmonic_kernels`: from harmonics over the blades to the tips and back;
- `blocks`: finds the blocks of given matrices and stores the matrices for the kernels.
"""
