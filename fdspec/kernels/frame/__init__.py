"""One frame of N storeys, by Taylor series."""
