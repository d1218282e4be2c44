"""Meshes and operators; knows no faces."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, {"catmull_clark": "catmull_clark"})
