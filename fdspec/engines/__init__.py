"""Buildings and motions to arrays, kernels, and back."""
