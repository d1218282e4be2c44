"""Weights from a performance: landmarks of another face, or what a phone recorded."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
