"""Fine stage: the coarse face deformed onto the landmarks."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
