"""Sparse operators on meshes, and what they are made of."""
