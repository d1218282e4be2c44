"""Weights of a rig that reproduce a face."""

import numpy as np
from scipy.optimize import lsq_linear

from toongeo.geometry.one_thread import one_thread
from toongeo.pipeline.rig.rig import Rig

__all__ = ["fit_pose"]

_RIDGE = 1e-6  # of the mean square of the blendshapes: decides between expressions that do the same
_LEAST = 0.002  # a weight below it moves nothing by 0.1 mm


def fit_pose(rig: Rig, vertices: np.ndarray, where: np.ndarray, *, ridge: float = _RIDGE) -> np.ndarray:
    """Weights (k,) in [0, 1] of the expressions whose face comes nearest to given vertices (bounded least squares).

    Parameters
    ----------
    rig : Rig
    vertices : (n, 3) float, mm
    where : (n,) bool
        Vertices that count.
    ridge : float
        Cost of the weights, in terms of the summed squares of the blendshapes: with more, expressions that undo each
        other are not both used.

    Returns
    -------
    (k,) float64
        All 0 where the vertices are the neutral face, or no expression moves it.

    Raises
    ------
    ValueError
        If the vertices are not as many as the rig's.
    """
    if vertices.shape != rig.neutral.shape:
        raise ValueError(f"vertices: expected shape {rig.neutral.shape} as the rig has, got {vertices.shape}")
    B = np.ascontiguousarray(rig.deltas[:, where]).reshape(len(rig.names), 3 * np.count_nonzero(where))
    motion = (vertices - rig.neutral)[where].ravel()
    if not (motion.any() and B.any()):
        return np.zeros(len(rig.names))
    with one_thread():
        gram, right = (B @ B.T).astype(np.float64), (B @ motion.astype(np.float32)).astype(np.float64)
        # The normal equations hold all of the problem: with a root of the Gram matrix it is one of 46 rows.
        root = np.linalg.cholesky(gram + ridge * np.trace(gram) * np.eye(len(gram)))
        solution = lsq_linear(root.T, np.linalg.solve(root, right), bounds=(0.0, 1.0), method="bvls")
    found = np.clip(solution.x, 0.0, 1.0)
    return np.where(found < _LEAST, 0.0, found)
