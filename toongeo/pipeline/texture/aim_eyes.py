"""Eyes that look where they look in the picture."""

import dataclasses

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.fit_eyes import SIDES, Eyes
from toongeo.pipeline.rig.gaze import GAZE_NAMES, gaze_weights
from toongeo.pipeline.texture.find_irises import Iris

LEAST_FRONT = 0.5  # cosine to the line of sight: an iris nearer to the outline of its eyeball is brought in to there


def aim_eyes(face: AlignedFace, eyes: Eyes, irises: tuple[Iris | None, Iris | None]) -> Eyes:
    """Keep the gaze of the picture as a pose of the eyes: each looks where its iris is seen.

    Parameters
    ----------
    face : AlignedFace
        For the camera.
    eyes : Eyes
    irises : left and right Iris, or None where none was found
        From :func:`find_irises`; None looks straight ahead.

    Returns
    -------
    Eyes
        With ``pose``, the ``eyeLook*`` weights in the order of ``GAZE_NAMES``, each in [0, 1].
    """
    weights: dict[str, float] = {}
    for side, iris in enumerate(irises):
        if iris is not None:
            direction = _towards(face, eyes.centres[side], eyes.radii[side], iris.centre)
            weights |= gaze_weights(SIDES[side], direction, eyes.turn[side])
    return dataclasses.replace(eyes, pose=np.array([weights.get(name, 0.0) for name in GAZE_NAMES]))


def _towards(face: AlignedFace, centre: np.ndarray, radius: float, px: np.ndarray) -> np.ndarray:
    """Direction (3,), model frame, from an eyeball's centre to the point of its front that projects to a pixel."""
    at, forward = face.camera.project(centre[None])[0], face.camera.depth(centre[None])[0]
    across = (face.camera.unproject(np.array([px]), np.array([forward]))[0] - centre) / radius
    towards_viewer = face.camera.unproject(at[None], np.array([forward + radius]))[0] - centre
    distance = np.linalg.norm(across)
    across *= min(1.0, np.sqrt(1 - LEAST_FRONT**2) / max(distance, 1e-12))
    return np.asarray(across + np.sqrt(1 - across @ across) * towards_viewer / np.linalg.norm(towards_viewer))
