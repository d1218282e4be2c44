"""Exaggerated faces: a deformation space that extrapolates (Wu et al. 2018); expressions of them (Chen et al. 2020)."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
