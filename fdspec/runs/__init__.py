"""Simulate and sweep: grids and motions to Datasets."""
