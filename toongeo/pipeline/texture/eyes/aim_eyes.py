"""Eyes that look where they look in the picture.

Constants were chosen by eye; which of the seven examples and 15 caricatures were looked at was not written down.
"""

import dataclasses

import numpy as np

from toongeo.model.anatomy.gaze import GAZE_NAMES, gaze_weights
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig import Eyes
from toongeo.pipeline.texture.eyes.find_irises import Iris

__all__ = ["LEAST_FRONT", "aim_eyes"]

LEAST_FRONT = 0.5  # cosine to the line of sight: an iris nearer to the outline of its eyeball is brought in to there

_UNSURE = (3.0, 6.0)  # degrees sideways, and up or down: how little the pose of a drawn head is known


def aim_eyes(
    face: AlignedFace,
    eyes: Eyes,
    irises: tuple[Iris | None, Iris | None],
    *,
    unsure: tuple[float, float] = _UNSURE,
) -> Eyes:
    """Keep the gaze of the picture as a pose of the eyes: each looks where its iris is seen.

    Parameters
    ----------
    face : AlignedFace
        For the camera.
    eyes : Eyes
    irises : left and right Iris, or None where none was found
        From :func:`find_irises`; None looks straight ahead.
    unsure : (2,) float, degrees
        So far sideways, and up or down, a gaze is taken for straight, and a wider one for so much narrower: at rest the
        irises then stay where they are drawn, unless they clearly look elsewhere.

    Returns
    -------
    Eyes
        With ``pose``, the ``eyeLook*`` weights in the order of ``GAZE_NAMES``, each in [0, 1].

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig, eyes = tg.fit_lids(face, tg.build_rig(face))
    >>> eyes = tg.aim_eyes(face, eyes, tg.find_irises(img, landmarks))
    >>> eyes.pose.shape, bool((eyes.pose >= 0).all() and (eyes.pose <= 1).all())
    ((8,), True)
    """
    weights: dict[str, float] = {}
    for side, iris in enumerate(irises[: len(eyes.templates)]):
        if iris is not None:
            direction = _towards(face, eyes.centres[side], eyes.radii[side], iris.centre)
            weights |= gaze_weights(SIDES[side], _narrowed(direction, unsure), eyes.turn[side])
    return dataclasses.replace(eyes, pose=np.array([weights.get(name, 0.0) for name in GAZE_NAMES]))


def _narrowed(direction: np.ndarray, unsure: tuple[float, float]) -> np.ndarray:
    """A direction (3,) whose angles sideways and upwards are nearer to 0 by ``unsure`` degrees, or 0."""
    x, y, z = direction
    angles = np.array([np.arctan2(x, z), np.arcsin(y)])
    sideways, up = np.sign(angles) * np.maximum(np.abs(angles) - np.radians(unsure), 0)
    return np.array([np.sin(sideways) * np.cos(up), np.sin(up), np.cos(sideways) * np.cos(up)])


def _towards(face: AlignedFace, centre: np.ndarray, radius: float, px: np.ndarray) -> np.ndarray:
    """Direction (3,), model frame, from an eyeball's centre to the point of its front that projects to a pixel."""
    at, forward = face.camera.project(centre[None])[0], face.camera.depth(centre[None])[0]
    across = (face.camera.unproject(np.array([px]), np.array([forward]))[0] - centre) / radius
    towards_viewer = face.camera.unproject(at[None], np.array([forward + radius]))[0] - centre
    distance = np.linalg.norm(across)
    across *= min(1.0, np.sqrt(1 - LEAST_FRONT**2) / max(distance, 1e-12))
    return np.asarray(across + np.sqrt(1 - across @ across) * towards_viewer / np.linalg.norm(towards_viewer))
