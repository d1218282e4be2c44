"""How sure the detector may be: of a face, and of each of its points."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import INNER, PARTS
from toongeo.pipeline.landmarks.search.passes import Passes
from toongeo.pipeline.landmarks.search.template_residuals import template_residuals

__all__ = ["FACE_CUES", "POINT_CUES", "FaceJudge", "face_cues", "point_cues"]

FACE_CUES = 6
POINT_CUES = FACE_CUES + 2
_LEAST_SPREAD, _LEAST_RESIDUAL = 1e-3, 5e-3  # radii
_PART_NAMES = tuple(PARTS)


@dataclass(frozen=True, eq=False)
class FaceJudge:
    """Logistic regressions: `face` (6,) of :func:`face_cues`, `points` (parts, 8) of :func:`point_cues`."""

    face: NDArray[np.float64]
    points: NDArray[np.float64]

    def face_chance(self, cues: NDArray[np.float64]) -> float:
        """The chance in (0, 1) that this is a face."""
        return float(_logistic(cues @ self.face))

    def point_chances(self, cues: NDArray[np.float64]) -> NDArray[np.float64]:
        """(68,) The chance in (0, 1) that each point lies within 8 % of the outer-eye distance from its place."""
        part = np.empty(68, np.int64)
        for k, name in enumerate(_PART_NAMES):
            part[PARTS[name]] = k
        return _logistic(np.einsum("kc,kc->k", cues, self.points[part]))


def face_cues(verified: float, box_score: float, flat: float, passes: Passes) -> NDArray[np.float64]:
    """(6,) What is known of a face: the scores of the verifier and of the box, how much it looks like a flat drawing,
    how far passes from other starts disagree (log), how far the points are from any face of the template (log), and
    1."""
    spread = np.log(passes.spread.mean() + _LEAST_SPREAD)
    misfit = np.sqrt((template_residuals(passes.points) ** 2).mean())
    return np.array([verified, box_score, flat, spread, np.log(misfit + _LEAST_RESIDUAL), 1.0])


def point_cues(passes: Passes, face: NDArray[np.float64]) -> NDArray[np.float64]:
    """(68, 8) What is known of each point: how far the passes disagree about it (log), how far it is from the nearest
    face of the template (log; for the jaw the mean of the others), and the cues of the face."""
    own = np.log(passes.spread + _LEAST_SPREAD)
    residuals = np.log(template_residuals(passes.points) + _LEAST_RESIDUAL)
    misfit = np.full(len(own), residuals.mean())
    misfit[INNER] = residuals
    return np.column_stack([own, misfit, np.repeat(face[None], len(own), axis=0)])


def _logistic(value: Any) -> Any:
    return 1 / (1 + np.exp(-np.clip(value, -30, 30)))
