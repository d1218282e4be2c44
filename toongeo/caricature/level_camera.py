"""A camera that does not take an exaggerated chin or forehead for a nod.

Constants were chosen on the seven examples and eight caricatures (``toongeo bench caricature``).
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from toongeo.arrays import Floats
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["level_camera"]

MOST_PITCH = 20.0  # degrees


def level_camera(camera: ScaledOrthographicCamera, points: Floats, pixels: Floats) -> ScaledOrthographicCamera:
    """The camera, with the pitch brought into ±20 degrees.

    A face without depth cues looks nodding when its lower half is drawn small, and looking up when it is drawn large;
    in a caricature that is what the drawing exaggerates. With a pitch of 40 degrees the shape pays for it: the
    forehead gets a dent, the nose a spike. Few faces are drawn from further above or below than the limit.

    Parameters
    ----------
    camera : ScaledOrthographicCamera
    points : (k, 3) float, mm
    pixels : (k, 2) float, px
        Where the points should be seen: scale and translation are found again for a changed rotation.
    """
    roll, pitch, yaw = Rotation.from_matrix(camera.rotation).as_euler("ZXY", degrees=True)
    if abs(pitch) <= MOST_PITCH:
        return camera
    limited = float(np.clip(pitch, -MOST_PITCH, MOST_PITCH))
    rotation = Rotation.from_euler("ZXY", [roll, limited, yaw], degrees=True).as_matrix()
    seen = points @ rotation[:2].T * [1.0, -1.0]
    a, b = seen - seen.mean(axis=0), pixels - pixels.mean(axis=0)
    scale = float((a * b).sum() / (a * a).sum())
    return ScaledOrthographicCamera(scale, rotation, pixels.mean(axis=0) - scale * seen.mean(axis=0))
