"""How far points are from those of any likely face of the default template."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.model.default_model import default_model
from toongeo.model.ibug68 import INNER

__all__ = ["template_residuals"]

_IDENTITIES = 30  # modes; the others hardly move a landmark
_ROUNDS = 4
_NOISE = 0.05  # radii: what caricatures differ from people, against one standard deviation of a mode


def template_residuals(landmarks: NDArray[np.float64]) -> NDArray[np.float64]:
    """(51,) Distances of the inner of 68 points (68, 2) px from the nearest likely face, in radii of the points.

    Pose and coefficients take turns: a scaled orthographic pose in closed form, then ridge regression on the modes of
    identity and named expressions.

    Examples
    --------
    >>> flat = default_model().mean[default_model().landmarks][:, :2] * [1, -1]
    >>> bool(template_residuals(flat).max() < 0.1 < template_residuals(flat[::-1].copy()).max())
    True
    """
    points = landmarks[INNER]
    radius = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
    mean, modes = _inner_template()
    shape = mean
    for _ in range(_ROUNDS):
        scale, rotation, shift = scaled_orthographic_pose(shape, points)
        camera = scale * rotation[:2] * [[1.0], [-1.0]]
        flat = (modes @ camera.T).reshape(len(modes), -1).T / (_NOISE * radius)
        aim = (points - shift - mean @ camera.T).ravel() / (_NOISE * radius)
        c = np.linalg.solve(flat.T @ flat + np.eye(len(modes)), flat.T @ aim)
        shape = mean + np.tensordot(c, modes, 1)
    return np.linalg.norm(shape @ camera.T + shift - points, axis=1) / radius


@cache
def _inner_template() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    model = default_model()
    rows = model.landmarks[INNER]
    identity = model.identity[:_IDENTITIES, rows].astype(np.float64)
    mean = model.mean[rows]
    if model.prior is not None:
        mean = mean + np.tensordot(model.prior.mean[:_IDENTITIES], identity, 1)
    expression = model.expression[: model.n_named, rows].astype(np.float64) * 0.5  # half of its range is usual
    return mean, np.concatenate([identity, expression])
