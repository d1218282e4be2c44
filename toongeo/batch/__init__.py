"""Many pictures, a rigged head each, on one computer or many."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
