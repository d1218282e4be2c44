"""Least-squares similarity between two point sets."""

from toongeo.geometry.rotations.similarity import similarity

__all__ = ["similarity"]
