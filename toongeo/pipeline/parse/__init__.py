"""Cuts a picture into the parts of a face, and moves eye landmarks to the lids (Pan et al. 2024, section 3.2.1)."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
