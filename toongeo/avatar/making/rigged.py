"""The rig of a face, with the contacts of its mouth."""

import dataclasses
from typing import Literal

import numpy as np

from toongeo.caricature import caricature_rig
from toongeo.model.anatomy.lips_apart import lips_apart
from toongeo.model.anatomy.parts import TEETH_AND_TONGUE
from toongeo.pipeline import AlignedFace, Rig, build_rig, fit_mouth, neutral_face
from toongeo.pipeline.rig.fit_pose import fit_pose

__all__ = ["mouth_warnings", "posed", "rigged"]

_SHUT = 0.02  # of the mouth's width: lips that are less apart, on the average, count as closed


def rigged(
    face: AlignedFace,
    landmarks: np.ndarray,
    rig: Literal["transfer", "caricature"],
    *,
    neutral: bool,
    gain: float | Literal["auto"],
) -> tuple[AlignedFace, Rig, np.ndarray]:
    """The face at rest, its expressions, and vertices (n, 3) of the face of the picture.

    What the contacts do to the neutral face (lips that meet) is done to the face of the picture too, but for lips that
    are apart in it and were closed.
    """
    if rig == "caricature":
        shapes = caricature_rig(face, landmarks)
        at_rest = dataclasses.replace(face, vertices=shapes.neutral)
    else:
        at_rest = neutral_face(face) if neutral else face
        shapes = build_rig(at_rest, gain=gain)
    closed = at_rest.fit is not face.fit
    shapes = fit_mouth(at_rest, shapes, face.vertices if closed else None)
    return at_rest, shapes, face.vertices if closed else shapes.neutral + (face.vertices - at_rest.vertices)


def posed(face: AlignedFace, rig: Rig) -> tuple[AlignedFace, Rig]:
    """The rig with the pose of the picture, and the face with teeth and tongue, which no alignment sees, as in it."""
    rig = dataclasses.replace(rig, pose=fit_pose(rig, face.vertices, face.region("skin"), ridge=1e-4))
    if not rig.pose.any():
        return face, rig
    inner = np.any([face.region(part) for part in TEETH_AND_TONGUE], axis=0)
    vertices = np.where(inner[:, None], rig.vertices(rig.pose), face.vertices)
    return dataclasses.replace(face, vertices=vertices), rig


def mouth_warnings(face: AlignedFace, rig: Rig) -> list[str]:
    """What to say of a mouth that is drawn open and does not close wholly."""
    if not (face.model.has("mouth_cavity") and rig.pose.any()):
        return []
    left, drawn = (lips_apart(face.model, V) for V in (rig.neutral, face.vertices))
    if not _SHUT < left < drawn:
        return []
    return [f"the lips are {100 * left:.0f} % of the mouth's width apart at rest ({100 * drawn:.0f} % in the picture)"]
