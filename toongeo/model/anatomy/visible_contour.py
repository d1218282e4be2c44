"""Where the outline of a deformed head meets its contour lines."""

import numpy as np

from toongeo.geometry import vertex_normals
from toongeo.model import MorphableModel
from toongeo.model.ibug68 import PARTS
from toongeo.protocols import HeadCamera

__all__ = ["visible_contour"]


def visible_contour(
    model: MorphableModel, camera: HeadCamera, V: np.ndarray, landmark_vertices: np.ndarray
) -> np.ndarray:
    """Landmark vertices with the jaw points slid along their contour lines to the outline.

    As in the coarse fit, a point takes the first vertex of its line, from the front, whose normal turns away from the
    camera, and the last one of a line that is seen to its end.

    Parameters
    ----------
    model : MorphableModel
    camera : HeadCamera
    V : (n, 3) float, mm, model frame
    landmark_vertices : (68,) int

    Returns
    -------
    (68,) int64
    """
    slid = np.array(landmark_vertices, np.int64)
    normals = vertex_normals(V, model.faces)
    for k, line in zip(PARTS["jaw"], model.contour_lines, strict=True):
        right, down = np.moveaxis(camera.jacobian(V[line]), 1, 0)
        turned = (normals[line] * np.cross(down, right)).sum(1) <= 0
        slid[k] = line[turned.argmax()] if turned.any() else line[-1]
    return slid
