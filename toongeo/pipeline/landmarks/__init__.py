"""Landmarks of the faces in a picture, found without a network."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
