"""Rotations, and the least-squares alignment of points."""
