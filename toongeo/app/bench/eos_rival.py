"""The fit of eos-py, which is installed apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model import load_eos

__all__ = ["EosRival"]

_SHAPE, _TABLE, _EXPRESSION = "sfm_shape_3448.bin", "ibug_to_sfm.txt", "expression_blendshapes_3448.bin"
_EDGES, _CONTOURS = "sfm_3448_edge_topology.json", "sfm_model_contours.json"


class EosRival:
    """Fits the Surrey model by ``eos.fitting.fit_shape_and_pose`` with contours and its defaults.

    Parameters
    ----------
    folder : Path
        With the files that eos ships for the 3448-vertex Surrey Face Model.

    Raises
    ------
    ValueError
        If eos-py is not installed, or a file is missing or not of its kind.
    """

    def __init__(self, folder: Path) -> None:
        try:
            import eos
        except ImportError:
            raise ValueError("eos: expected eos-py, which is not installed: pip install eos-py==1.5.0") from None
        for name in (_SHAPE, _TABLE, _EXPRESSION, _EDGES, _CONTOURS):
            if not (folder / name).is_file():
                raise ValueError(f"eos: expected the file {name} in {folder}, got none")
        surrey = load_eos(folder / _SHAPE, folder / _TABLE)
        self._vertices = surrey.landmarks
        self._fitting, self._landmark = eos.fitting, eos.core.Landmark
        shape = eos.morphablemodel.load_model(str(folder / _SHAPE))
        self._model = eos.morphablemodel.MorphableModel(
            shape.get_shape_model(),
            eos.morphablemodel.load_blendshapes(str(folder / _EXPRESSION)),
            color_model=eos.morphablemodel.PcaModel(),
        )
        self._mapper = eos.core.LandmarkMapper(str(folder / _TABLE))
        self._contour = (
            eos.morphablemodel.load_edge_topology(str(folder / _EDGES)),
            eos.fitting.ContourLandmarks.load(str(folder / _TABLE)),
            eos.fitting.ModelContour.load(str(folder / _CONTOURS)),
        )

    def landmarks(self, landmarks: NDArray[np.float64], size: tuple[int, int]) -> NDArray[np.float64]:
        """Where the fitted face has the landmarks, (68, 2) px; ``size`` is (width, height) of the picture."""
        there = np.flatnonzero(np.isfinite(landmarks).all(axis=1))
        points = [self._landmark(str(k + 1), landmarks[k].astype(np.float32)) for k in there]
        mesh, rendering, _, _ = self._fitting.fit_shape_and_pose(
            self._model, points, self._mapper, *size, *self._contour
        )
        vertices = np.asarray(mesh.vertices)[self._vertices, :3]
        clip = np.c_[vertices, np.ones(len(vertices))] @ (rendering.get_projection() @ rendering.get_modelview()).T
        return (np.array([1, -1]) * clip[:, :2] / clip[:, 3:] + 1) / 2 * size
