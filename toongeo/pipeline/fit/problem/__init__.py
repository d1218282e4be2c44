"""The optimisation problem of a landmark fit, and the way to its solution."""
