"""fdspec against what its users would pick instead: ``python -m benchmarks``, reported, never asserted."""
