"""Expressions of caricatures (Chen et al. 2020)."""
