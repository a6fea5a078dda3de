"""One storey in closed form."""
