"""What of a picture is beyond the library, said in the report instead of hidden in a head that looks wrong."""

import numpy as np

from toongeo.model.ibug68 import OUTER_EYES, PARTS
from toongeo.pipeline import AlignedFace, LandmarkEvidence, Rig
from toongeo.pipeline.texture.find_glasses import Glasses

__all__ = ["beyond_warnings"]

_PROFILE = 60.0  # degrees of yaw; the far half of the face is hidden from there on
# Height over width of an eye's points. Closed eyes have 0.03 to 0.05, the narrowest open ones of 25 pictures 0.14.
_CLOSED = 0.1
# Outer-eye distances that jawOpen moves the inner lips apart; on ten pictures 0.22 to 0.49, the least a mouth drawn
# a quarter of the eyes' distance wide.
_OPENS = 0.1
_GLASSES = {
    "clear": "the glasses in the picture are left out of the head",
    "dark": "dark glasses hide the eyes: they are left out of the head, and its eyes are made up",
}
_INNER_LIPS = (61, 62, 63), (67, 66, 65)


def beyond_warnings(
    evidence: LandmarkEvidence, landmarks: np.ndarray, face: AlignedFace, rig: Rig, glasses: Glasses | None = None
) -> list[str]:
    """Sentences about a blank picture, points of another one, profiles, closed and hidden eyes, glasses, and mouths
    that do not open.

    Parameters
    ----------
    evidence : LandmarkEvidence
        Of the landmarks in the picture.
    landmarks : (68, 2) float, px
        NaN rows are missing.
    face : AlignedFace
    rig : Rig
    glasses : Glasses or None
        Those that were found and left out of the head.
    """
    warnings = []
    if evidence.is_blank:
        warnings.append("the picture shows nothing where the landmarks are")
    elif not evidence.is_plausible:
        chance = 100 * evidence.chance
        warnings.append(
            f"the picture hardly shows a face at the landmarks (chance {chance:.1f} %): are they another's?"
        )
    elif glasses is not None:
        warnings.append(_GLASSES[glasses.kind])
    elif evidence.has_dark_glasses:
        warnings.append("the eyes seem to be behind dark glasses, which are painted on lids and eyeballs")
    yaw = abs(face.camera.yaw)
    if yaw > _PROFILE:
        warnings.append(f"the head is turned by {yaw:.0f} degrees, a profile: its far half is a guess")
    return warnings + _eyes(landmarks) + _mouth(face, rig)


def _eyes(landmarks: np.ndarray) -> list[str]:
    shut = [side for side in ("left", "right") if _opening(landmarks[PARTS[f"eye_{side}"]]) < _CLOSED]
    if len(shut) == 2:
        return ["both eyes are closed in the picture: skin is painted on the eyeballs"]
    return [f"the {side} eye is closed in the picture, a wink: skin is painted on its eyeball" for side in shut]


def _opening(eye: np.ndarray) -> float:
    """Height over width of an eye's six points, from corner over the upper lid and back; inf if one is missing."""
    width, height = (np.linalg.norm(eye[a] - eye[b], axis=-1).mean() for a, b in (([0], [3]), ([1, 2], [5, 4])))
    return float(height / max(width, 1e-9)) if np.isfinite(eye).all() else np.inf


def _mouth(face: AlignedFace, rig: Rig) -> list[str]:
    if "jawOpen" not in rig.names:
        return []
    at = face.landmark_vertices
    upper, lower = (at[list(rows)] for rows in _INNER_LIPS)
    apart = [np.linalg.norm(V[upper] - V[lower], axis=1).mean() for V in (rig.neutral, rig.vertices({"jawOpen": 1.0}))]
    unit = np.linalg.norm(np.subtract(*rig.neutral[at[list(OUTER_EYES)]]))
    if apart[1] - apart[0] >= _OPENS * unit:
        return []
    return ["the mouth hardly opens: it is very small, or its landmarks are not where it is"]
