"""Every face of a picture, with its landmarks."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.pipeline.landmarks.evidence.eye_light import are_dark, light_about_eyes
from toongeo.pipeline.landmarks.evidence.upright_crop import EYES, upright_crop
from toongeo.pipeline.landmarks.search.detector_file import shipped_detector
from toongeo.pipeline.landmarks.search.find_faces import FoundFace, find_faces
from toongeo.protocols import LandmarkDetection

__all__ = ["detect_faces"]

_LONGEST_PX = 960  # of the picture that is worked on: a face of interest has some 100 px then, and memory is bounded
_SHORTEST_PX = 8
# Of the chance of eye points behind dark glasses: on 60 such renders 0.34 of them are right, and 0.68 was said.
_HIDDEN = 0.5


def detect_faces(img: NDArray[np.uint8]) -> list[LandmarkDetection]:
    """The faces of a picture, the largest first; an empty list if there is none.

    No network runs. Boxes come from linear templates on orientation histograms over a pyramid, upright and, if no face
    is sure, tilted; the landmarks from a cascade of linear regressions on orientation maps around them, run from
    several starts and on the mirrored picture, of which the median is taken. All of it was trained on renders of the
    default template: people, caricatures and cartoons, in many styles. Points of eyes behind dark glasses are a guess,
    and their confidence says so.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB

    Returns
    -------
    list of LandmarkDetection

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8.

    References
    ----------
    N. Dalal, B. Triggs, "Histograms of oriented gradients for human detection", CVPR 2005. X. Xiong, F. De la Torre,
    "Supervised descent method and its applications to face alignment", CVPR 2013. Mirrored and jittered starts: H.
    Yang, I. Patras, "Mirror, mirror on the wall, tell me, is the error small?", CVPR 2015.

    Examples
    --------
    >>> detect_faces(np.full((120, 160, 3), 200, np.uint8))
    []
    """
    check_image(img)
    height, width = img.shape[:2]
    if min(height, width) < _SHORTEST_PX:
        return []
    scale = min(1.0, _LONGEST_PX / max(height, width))
    size = max(_SHORTEST_PX, round(width * scale)), max(_SHORTEST_PX, round(height * scale))
    small = img if scale == 1 else cv2.resize(img, size, interpolation=cv2.INTER_AREA)
    back = np.array([width, height]) / size
    grey = cv2.cvtColor(small, cv2.COLOR_RGB2GRAY)
    if np.ptp(grey) == 0:
        return []
    with one_thread():  # how BLAS splits a sum among threads would show in the last digits
        found = find_faces(grey, shipped_detector())
    return [LandmarkDetection((face.points + 0.5) * back - 0.5, _doubted(small, face), face.chance) for face in found]


def _doubted(img: np.ndarray, face: FoundFace) -> NDArray[np.float64]:
    """The confidence (68,) of a face's points, less at eyes that are not seen."""
    confidence = face.confidence.copy()
    if are_dark(light_about_eyes(upright_crop(img, face.points))):
        confidence[np.concatenate(EYES)] *= _HIDDEN
    return confidence
