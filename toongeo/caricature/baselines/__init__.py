"""Rivals of the deformation space, for comparisons."""
