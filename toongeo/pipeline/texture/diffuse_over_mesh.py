"""Breadth-first diffusion of colours over the vertices of a mesh."""

import numpy as np
import scipy.sparse as sp

from toongeo.geometry import adjacency

__all__ = ["diffuse_over_mesh", "diffused"]


def diffuse_over_mesh(F: np.ndarray, colours: np.ndarray, known: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Give unknown vertices the mean colour of their known neighbours, ring by ring.

    The diffusion of Pan et al. (2024, section 3.2.3) carried from the picture's grid to the surface, where the seams
    of the atlas do not stop it.

    Parameters
    ----------
    F : (m, 3) int
    colours : (n, c) float
        Those of unknown vertices are not read.
    known : (n,) bool

    Returns
    -------
    filled : (n, c) float64
        Vertices that no edge path joins to a known one keep their value.
    rings : (n,) int64
        Distance to the known vertices in edges: 0 where known, -1 where unreachable.

    Examples
    --------
    >>> F = np.array([[0, 1, 2], [2, 1, 3]])
    >>> colours, known = np.array([[4.0], [2.0], [0.0], [0.0]]), np.array([True, True, False, False])
    >>> filled, rings = diffuse_over_mesh(F, colours, known)
    >>> filled.ravel(), rings
    (array([4., 2., 3., 2.]), array([0, 0, 1, 1]))
    """
    return diffused(adjacency(F, len(colours)), colours, known, len(colours))


def diffused(edges: sp.csr_array, colours: np.ndarray, known: np.ndarray, reach: int) -> tuple[np.ndarray, np.ndarray]:
    """:func:`diffuse_over_mesh` for edges (n, n) that are at hand, and no farther than ``reach`` rings."""
    filled = np.array(colours, float)
    rings = np.where(known, 0, -1)
    visited = np.column_stack([np.where(known[:, None], filled, 0), known])
    for ring in range(1, reach + 1):
        total = edges @ visited
        frontier = np.flatnonzero((rings < 0) & (total[:, -1] > 0))
        if not len(frontier):
            break
        filled[frontier] = total[frontier, :-1] / total[frontier, -1:]
        visited[frontier, :-1], visited[frontier, -1] = filled[frontier], 1
        rings[frontier] = ring
    return filled, rings
