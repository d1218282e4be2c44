"""A deformation of a source, as deformation transfer needs it for any target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.deformation.transfer_operators import fourth_edges

__all__ = ["SourceMotion", "source_motion"]


@dataclass(frozen=True, eq=False)
class SourceMotion:
    """How a source's vertices and the fourth vertices of its triangles move.

    Attributes
    ----------
    moved : (n, 3) float
        Displacements of the vertices.
    touched : (t,) int64
        Triangles with a vertex that moves; most expressions leave most triangles as they are.
    tilted : (t, 3) float64
        How far the fourth vertices of these move from the first (Eq. 14 of Pan et al. 2024).
    """

    moved: NDArray[np.floating]
    touched: NDArray[np.int64]
    tilted: NDArray[np.float64]


def source_motion(
    V_source: NDArray[np.float64], corners: NDArray[np.int64], moved: NDArray[np.floating]
) -> SourceMotion:
    """Motion of a source (n, 3) with triangles given by their corners (3, m), for displacements (n, 3)."""
    touched = np.flatnonzero((moved != 0).any(axis=1)[corners].any(axis=0))
    corners = np.ascontiguousarray(corners[:, touched])
    tilted = fourth_edges(V_source + moved, corners) - fourth_edges(V_source, corners)
    return SourceMotion(moved, touched, tilted)
