"""A face moved most of the way to its landmarks without a fold.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/alignment.py``).
"""

from typing import Literal

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.visible_contour import visible_contour
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.align.symmetric_field import FieldPrior, most_likely_field
from toongeo.protocols import HeadCamera

__all__ = ["symmetric_flow"]

_STRIDE = 0.1  # outer-eye distances; the farthest landmark goes so far in a step
_LEAST_STEPS, _MOST_STEPS = 2, 5  # the points of the jaw are placed anew after each
_PRIOR = FieldPrior()


def symmetric_flow(
    model: MorphableModel,
    camera: HeadCamera,
    V: np.ndarray,
    landmark_vertices: np.ndarray,
    landmarks: np.ndarray,
    depth: Literal["keep", "scaled"],
    slide: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """Move all vertices by the smooth, rather symmetric motion that best takes the landmark vertices to their places.

    In steps, each a field over the space that the face has reached: points flow along, and a flow of a smooth field
    never brings two points together. So lids and lips keep their order and nothing folds, however strong the
    exaggeration; and what no landmark tells follows the other half of the face.

    Parameters
    ----------
    model : MorphableModel
    camera : HeadCamera
    V : (n, 3) float, mm, model frame
    landmark_vertices : (68,) int
    landmarks : (68, 2) float, px
        NaN rows are missing.
    depth : {"keep", "scaled"}
        Whether the vertices keep their depth, or depth is part of the motion.
    slide : bool
        Whether jaw points move to the outline as it changes.

    Returns
    -------
    vertices : (n, 3) float64
    landmark_vertices : (68,) int64
    """
    seen = np.isfinite(landmarks).all(1)
    unit = float(np.linalg.norm(np.subtract(*V[model.landmarks[list(OUTER_EYES)]])))
    left = _LEAST_STEPS
    for step in range(_MOST_STEPS + 1):
        at = landmark_vertices[seen]
        jacobians = camera.jacobian(V[at]) * unit
        px = np.sqrt((jacobians**2).mean() * 3)  # of a unit across the view
        missed = (landmarks[seen] - camera.project(V[at])) / px
        if step == 0:
            left = int(np.clip(np.ceil(np.abs(missed).max() / _STRIDE), _LEAST_STEPS, _MOST_STEPS))
        moved = V + unit * most_likely_field(V / unit, V[at] / unit, jacobians / px, missed / max(left, 1), _PRIOR)
        V = moved if depth == "scaled" else camera.unproject(camera.project(moved), camera.depth(V))
        left -= 1
        if left < 0:
            break  # the last step has closed what the noise of the prior had left
        if slide and left > 0:
            landmark_vertices = visible_contour(model, camera, V, landmark_vertices)
    return V, landmark_vertices
