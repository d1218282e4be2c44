"""MediaPipe's face mesh as iBUG-68: ``VERTICES`` (68,) are the mesh points, from a table in ``data_templates/``.

>>> VERTICES[[36, 45, 30]], N_MESH, N_WITH_IRISES
(array([ 33, 263,   4]), 468, 478)
"""

import csv

import numpy as np

from toongeo.model.data_path import data_path

__all__ = ["N_MESH", "N_WITH_IRISES", "VERTICES"]

N_MESH = 468
N_WITH_IRISES = 478  # the ten points of the irises follow those of the mesh


def _vertices() -> np.ndarray:
    with open(data_path("data_templates/mediapipe478.csv"), encoding="utf-8", newline="") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        vertices = np.array([int(row["vertex"]) for row in rows], np.int64)
    vertices.setflags(write=False)
    return vertices


VERTICES = _vertices()
