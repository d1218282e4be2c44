"""Landmarks of a fit: schemes, weights, silhouettes, errors."""
