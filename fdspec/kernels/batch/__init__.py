"""Many single-storey histories side by side."""
