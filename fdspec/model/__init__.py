"""Buildings, damping, motions and grids: frozen, validated, SI units."""
