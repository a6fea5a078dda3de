"""numba: its options, the cache of compiled kernels."""
