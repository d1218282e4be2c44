"""The other side of a mesh that nobody has put upright."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from toongeo.arrays import Floats, Integers

__all__ = ["mirror_partners"]

_SAMPLE = 3000  # vertices that look for the plane: on heads more change its normal by less than a tenth of a degree
_TURNS = 15, 300  # of matching and fitting: to tell planes from each other, and at most until the best stands still
_STILL = 1e-14  # what is missing to 1 of the cosine between one normal and the next: 1e-7 radians
_TRIMMED = 0.7  # share of the pairs, the nearest ones, that a plane is fitted to: hair may be parted
# Of the size: half of the mirrored vertices are nearer to the mesh. On the template a wrong plane leaves 0.009 or more,
# since all heads are round, and the right one nothing; a quarter of a centimetre is what faces differ by.
_WORST = 0.007


def mirror_partners(V: Floats, *, worst: float = _WORST) -> Integers | None:
    """For every vertex the one nearest to its image in the mesh's plane of symmetry.

    The plane is found by matching mirrored vertices with the nearest ones and fitting it to the pairs, in turns, from
    the planes across the axes of the file and across the principal axes; that which leaves the least is taken.

    Parameters
    ----------
    V : (n, 3) float
        In any frame and unit.
    worst : float
        How far half of the mirrored vertices may be from the mesh, in diagonals of the bounding box; what lies between
        vertices is half as far from them as they are from each other.

    Returns
    -------
    (n,) int64 or None
        None if the mesh has no such plane.

    Examples
    --------
    >>> V = np.array([[-2.0, 1, 0], [0, 0, 0], [2, 1, 0], [0, 3, 1], [-1, 0, 2], [1, 0, 2]]) + 7
    >>> mirror_partners(V)
    array([2, 1, 0, 3, 5, 4])
    """
    V = np.asarray(V, np.float64)
    size = float(np.linalg.norm(np.ptp(V, axis=0)))
    if len(V) < 4 or size <= 0:
        return None
    middle = V.mean(axis=0)
    V = (V - middle) / size
    tree, sample = cKDTree(V), V[:: -(-len(V) // _SAMPLE)]
    principal = np.linalg.svd(sample - sample.mean(axis=0), full_matrices=False)[2]
    planes = [_settled(sample, V, tree, normal, _TURNS[0]) for normal in (*np.eye(3), *principal)]
    left = [float(np.median(tree.query(_mirrored(sample, *plane))[0])) for plane in planes]
    if min(left) > worst + float(np.median(tree.query(sample, k=2)[0][:, 1])) / 2:
        return None
    plane = _settled(sample, V, tree, planes[int(np.argmin(left))][0], _TURNS[1])
    return np.asarray(tree.query(_mirrored(V, *plane))[1], np.int64)


def _mirrored(V: Floats, normal: Floats, offset: float) -> Floats:
    return V - 2 * (V @ normal - offset)[:, None] * normal


def _settled(sample: Floats, V: Floats, tree: cKDTree, normal: Floats, turns: int) -> tuple[Floats, float]:
    """The plane ``normal . x = offset`` that lies midway between the pairs that it makes."""
    offset = float(sample.mean(axis=0) @ normal)
    for _ in range(turns):
        far, partners = tree.query(_mirrored(sample, normal, offset))
        near = far <= np.quantile(far, _TRIMMED)
        p, q = sample[near], V[partners[near]]
        across, between = p - q, (p + q) / 2
        between = between - between.mean(axis=0)
        # Pairs differ along the normal, and their midpoints do not.
        found = np.linalg.eigh(across.T @ across - 4 * between.T @ between)[1][:, -1]
        moved = abs(1 - abs(found @ normal))
        normal, offset = found, float(((p + q) / 2).mean(axis=0) @ found)
        if moved < _STILL:
            break
    return normal, offset
