"""Avatars: made from a picture, posed, rendered, saved and loaded."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
