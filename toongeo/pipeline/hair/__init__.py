"""Hair as a closed shell about the head, from the pixels of one picture that show it."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
