"""Oscillators, roots, extrema and quadrature: no friction in them."""
