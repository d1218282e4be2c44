"""From a photograph to a drawing: a warp of the face, and an appearance (Pan et al. 2024, section 3, classically)."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
