"""Measures: how far landmarks and colours are off, how sound a mesh is."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
