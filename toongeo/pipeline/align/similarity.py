"""Least-squares similarity between two point sets."""

from toongeo.geometry.similarity import similarity

__all__ = ["similarity"]
