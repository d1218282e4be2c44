"""Places where another part, a learned one included, can be plugged in.

Each Protocol is satisfied by shape, not by inheritance: any object or function with these members fits."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
