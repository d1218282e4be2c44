"""Does the picture show a face where its landmarks are?"""

import csv
from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only
from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.io.landmark_array import landmark_array
from toongeo.model.data_path import data_path
from toongeo.pipeline.landmarks.evidence.colour_cues import COLOUR_CUES, colour_cues
from toongeo.pipeline.landmarks.evidence.edge_cues import EDGE_CUES, edge_cues
from toongeo.pipeline.landmarks.evidence.eye_light import are_dark, light_about_eyes
from toongeo.pipeline.landmarks.evidence.upright_crop import upright_crop
from toongeo.pipeline.landmarks.search.detector_file import shipped_detector
from toongeo.pipeline.landmarks.search.frames import applied, box_of, inverse, similarity_onto
from toongeo.pipeline.landmarks.search.passes import face_patch

__all__ = ["CUES", "LandmarkEvidence", "evidence_cues", "landmark_evidence"]

CUES = (*EDGE_CUES, *COLOUR_CUES, "face", "constant")
_PLAUSIBLE = 0.08  # of 180 renders with right points none has less, of 309 with wrong ones 299 have
_BLANK = 1.5  # CIELAB; the lightness of a face of the faintest pencil drawing spreads by 4 and more
_FEWEST = 6


@dataclass(frozen=True, eq=False)
class LandmarkEvidence:
    """What a picture says for its landmarks.

    Attributes
    ----------
    cues : (8,) float64
        By the names of ``CUES``: edges along lids, lips and jaw; irises, lips, skin; whether the whole looks like a
        face to the detector's verifier; and 1.
    chance : float in (0, 1)
        That the points are this picture's, by a logistic regression on the cues, where they are as likely as points of
        another picture.
    spread : float
        Standard deviation of the lightness (CIELAB) between jaw and brows.
    eye_light : (2,) float64
        How light what lies about right and left eye is, nearly all of it, as a share of the skin's lightness.
    """

    cues: Floats
    chance: float
    spread: float
    eye_light: Floats

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        read_only(self, "cues", "eye_light")

    @property
    def is_blank(self) -> bool:
        """Whether nothing at all is to be seen there."""
        return self.spread < _BLANK

    @property
    def is_plausible(self) -> bool:
        """Whether the points may be this picture's."""
        return not self.is_blank and self.chance >= _PLAUSIBLE

    @property
    def has_dark_glasses(self) -> bool:
        """Whether both eyes are dark to well beyond their lids."""
        return are_dark(self.eye_light)


def landmark_evidence(img: NDArray[np.uint8], landmarks: NDArray[np.float64]) -> LandmarkEvidence:
    """What a picture says for points that are said to be its landmarks.

    Nothing is searched for: seven cues are measured on the face upright and at one size, and weighed by what renders of
    the default template with right points and with others' points have (``data_templates/build/landmark_evidence.py``).

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
        NaN rows are missing, and stand where the mean face has them.

    Returns
    -------
    LandmarkEvidence

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the landmarks are not (68, 2) or fewer than 6 are known.

    Examples
    --------
    >>> from toongeo.io import read_image, read_landmarks
    >>> from toongeo.model import data_path
    >>> img, points = (
    ...     read(data_path(f"examples/portraits/blue_girl.{suffix}"))
    ...     for read, suffix in ((read_image, "png"), (read_landmarks, "pts"))
    ... )
    >>> landmark_evidence(img, points).is_plausible, landmark_evidence(img, points + [60, 40]).is_plausible
    (True, False)
    """
    check_image(img)
    points = _completed(landmark_array(landmarks))
    cues = evidence_cues(img, points)
    crop = upright_crop(img, points)
    chance = 1 / (1 + np.exp(-np.clip(cues @ _weights(), -30, 30)))
    spread = crop.lab[crop.face()][:, 0].std() if crop.face().any() else 0.0
    return LandmarkEvidence(cues, float(chance), float(spread), light_about_eyes(crop))


def evidence_cues(img: NDArray[np.uint8], points: Floats) -> Floats:
    """(8,) float64 by the names of ``CUES``, for points (68, 2) px that are all known."""
    crop = upright_crop(img, points)
    patch = face_patch(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY), box_of(points))
    parts = shipped_detector()
    with one_thread():
        face = parts.verifier.look(patch.grey, applied(patch.matrix, points), parts.cascade).face
    return np.r_[edge_cues(crop), colour_cues(crop), face, 1.0]


def _completed(points: Floats) -> Floats:
    """Points with those that are missing put where the mean face has them."""
    seen = np.isfinite(points[:, 0])
    if seen.sum() < _FEWEST:
        raise ValueError(f"landmarks: expected at least {_FEWEST} points that are not NaN, got {seen.sum()}")
    mean = shipped_detector().cascade.shape
    return np.where(seen[:, None], points, applied(inverse(similarity_onto(points[seen], mean[seen])), mean))


@cache
def _weights() -> Floats:
    with open(data_path("data_templates/landmark_evidence.csv"), encoding="utf-8", newline="") as file:
        rows = {row["cue"]: float(row["weight"]) for row in csv.DictReader(r for r in file if not r.startswith("#"))}
    return np.array([rows[name] for name in CUES])
