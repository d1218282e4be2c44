"""Detectors and networks of others, each behind the protocol that it serves; none is loaded before it is made."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
