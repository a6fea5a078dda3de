"""Frames of N storeys side by side: eight histories in the lanes of a vector, each at its own time."""
