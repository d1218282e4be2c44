"""The way of the data, a stage a folder: landmarks, fit, parse, align, texture, rig."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
