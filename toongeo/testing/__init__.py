"""Checks that a part of yours does what its protocol asks for, for your own tests."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
