"""How much of the eyeballs shows."""

from collections.abc import Mapping

import numpy as np

from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.rig import Rig
from toongeo.render import ScaledOrthographicCamera, rasterize

__all__ = ["visible_eyeballs"]

_EXTENT = 2.6  # radii that a picture of one eye spans


def visible_eyeballs(
    face: AlignedFace, rig: Rig, eyes: Eyes, weights: Mapping[str, float], *, yaw: float = 0.0, size: int = 200
) -> np.ndarray:
    """Share of each eyeball's disc that is seen, (2,), left and right.

    Parameters
    ----------
    face : AlignedFace
        For its triangles.
    rig : Rig
    eyes : Eyes
    weights : mapping of name to weight
    yaw : float
        Degrees; > 0 turns the face to the subject's left.
    size : int
        Side of the picture of an eye, px; the eyeball is ``size / 2.6`` wide.

    Returns
    -------
    (2,) float64
        Pixels in which the eyeball is the nearest surface, wherever that is, over those of a disc of its radius.
    """
    V = [rig.vertices(weights), *(eyes.looking(side, dict(weights)) for side in range(len(SIDES)))]
    F = [face.faces, *(eye.faces for eye in eyes.templates)]
    firsts = np.cumsum([0, *map(len, V)])
    starts = np.cumsum([0, *map(len, F)])
    points, faces = np.vstack(V), np.vstack([f + first for f, first in zip(F, firsts[:-1], strict=True)])
    shares = []
    for side in range(len(SIDES)):
        extent = _EXTENT * eyes.radii[side]
        camera = ScaledOrthographicCamera.look(yaw, size=size, centre=eyes.centres[side], extent=extent)
        ids = rasterize(np.column_stack([camera.project(points), camera.depth(points)]), faces, size, size).face_ids
        seen = (ids >= starts[side + 1]) & (ids < starts[side + 2])
        shares.append(seen.sum() / (np.pi * (size / _EXTENT) ** 2))
    return np.array(shares)
