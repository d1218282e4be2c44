"""Parts of a head drawn inside an outline."""

import cv2
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.arrays import Reals
from toongeo.geometry import adjacency
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.hair.plane.masks import signed
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane

__all__ = ["drawn_inside"]


_INSIDE_MM = 5.0  # between the outline and what is drawn inside: with 3.5 covered ears show as bulges of the shell
_ROUNDS, _PASSES = 4, 6  # pushes, and passes that spread each over the neighbours


def drawn_inside(
    face: AlignedFace, plane: WorkingPlane, X: Reals, outline: NDArray[np.bool_], moving: NDArray[np.bool_]
) -> Reals:
    """Displacement (n, 3) in the plane, across the view, that brings moving vertices 5 mm inside cells of an outline.

    X is (n, 3) in the plane's frame. Their neighbours that are no part of the face follow smoothly.
    """
    inside = signed(outline)
    rows_, columns_ = np.gradient(cv2.GaussianBlur(inside, (0, 0), 2.0), CELL_MM)
    F = face.faces
    outer = (face.region("skin") | face.region("neck"))[F].all(1)
    edges = adjacency(F[outer], len(X)).astype(np.float64)
    mean = sp.diags_array(1.0 / np.maximum(np.diff(edges.indptr), 1)) @ edges
    beside = (mean @ moving.astype(np.float64) > 0) & ~face.region("face")
    beside[face.landmark_vertices] = False
    rows = np.flatnonzero(moving | beside)
    D = np.zeros((len(X), 2))
    for turn in range(_ROUNDS):
        at = X[:, :2] + D
        way = np.column_stack([plane.sample(columns_, at), plane.sample(rows_, at)])
        way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-3)
        D += way * (np.clip(_INSIDE_MM - plane.sample(inside, at), 0, 60) * moving)[:, None]
        if turn < _ROUNDS - 1:
            for _ in range(_PASSES):
                D[rows] = 0.5 * D[rows] + 0.5 * (mean[rows] @ D)
    return np.column_stack([D, np.zeros(len(D))])
