"""Compiled kernels: numbers in, numbers out.  They import numba, numpy, math and fdspec.compiler alone."""
