"""A drawing in the manner of another."""
