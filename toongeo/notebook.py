"""Pictures of results, for notebooks: what their ``_repr_png_`` shows."""

from __future__ import annotations

from functools import singledispatch

import cv2
import numpy as np

from toongeo.arrays import Bytes, Floats
from toongeo.avatar import Avatar
from toongeo.io import encode_image
from toongeo.model import MorphableModel, default_model
from toongeo.pipeline import AlignedFace, FaceFit, Rig
from toongeo.protocols import Camera, FaceLabel, FaceParse
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

__all__ = ["picture", "png"]

_TILE = 240  # px; four tiles of a textured head stay below 300 kB as PNG
_SMALL = 150  # px, where there are many
_HEADROOM = 1.12  # of the head's height: how much of the world a tile shows
_MODES = 3  # of identity
_DEVIATIONS = 2.0  # what of a mode is shown: 95 of 100 faces lie within
_SMILE = {"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9}
# The parts of a face that show what a rig can do; those that it has not are left out.
_EXPRESSIONS = (
    {"jawOpen": 0.8},
    _SMILE,
    {"mouthPucker": 1.0},
    {"mouthFrownLeft": 1.0, "mouthFrownRight": 1.0},
    {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    {"browInnerUpLeft": 1.0, "browInnerUpRight": 1.0, "browOuterUpLeft": 1.0, "browOuterUpRight": 1.0},
    {"noseSneerLeft": 1.0, "noseSneerRight": 1.0},
)
_COLOURS = {
    FaceLabel.BACKGROUND: (238, 238, 240),
    FaceLabel.SKIN: (240, 200, 170),
    FaceLabel.BROW_LEFT: (110, 70, 40),
    FaceLabel.BROW_RIGHT: (150, 100, 60),
    FaceLabel.EYE_LEFT: (60, 120, 200),
    FaceLabel.EYE_RIGHT: (100, 160, 230),
    FaceLabel.NOSE: (230, 160, 120),
    FaceLabel.UPPER_LIP: (200, 60, 70),
    FaceLabel.LOWER_LIP: (230, 90, 100),
    FaceLabel.INNER_MOUTH: (120, 20, 40),
    FaceLabel.HAIR: (90, 60, 120),
    FaceLabel.EARS: (250, 180, 90),
    FaceLabel.NECK: (200, 170, 140),
    FaceLabel.OTHER: (130, 130, 130),
    FaceLabel.HAT: (60, 150, 110),
}
_WIDEST = 480  # px, of a parse


def png(instance: object) -> bytes | None:
    """The picture of a result as a PNG file; None if there is nothing to show."""
    shown = picture(instance)
    return None if shown is None else encode_image(shown)


@singledispatch
def picture(instance: object) -> Bytes | None:
    """A small picture (h, w, 3) of a result: views, expressions, faces of a model, or the labels of a picture.

    Known are `Avatar`, `FaceFit`, `AlignedFace`, `MorphableModel`, `Rig` and `FaceParse`; None of others, and of a rig
    whose triangles are not those of the default model, which it does not hold.

    Examples
    --------
    >>> picture(default_model()).shape[0] > 100, picture("a text")
    (True, None)
    """
    return None


@picture.register
def _(avatar: Avatar) -> Bytes:
    smile = {name: weight for name, weight in _SMILE.items() if name in avatar.names}
    views = ((avatar.pose, 0.0), (avatar.pose, 35.0), (avatar.pose, 80.0), (smile, 0.0))
    return np.hstack([avatar.render(weights, _TILE, yaw) for weights, yaw in views])


@picture.register
def _(fit: FaceFit) -> Bytes:
    return _views(fit.vertices, fit.model, fit.camera.yaw, fit.camera.pitch)


@picture.register
def _(face: AlignedFace) -> Bytes:
    return _views(face.vertices, face.model, face.camera.yaw, face.camera.pitch)


@picture.register
def _(model: MorphableModel) -> Bytes:
    mean = np.asarray(model.mean, np.float64)
    camera = _camera(mean, model, _SMALL)
    faces = [mean]
    for mode in model.identity[:_MODES]:
        faces += [mean - _DEVIATIONS * mode, mean + _DEVIATIONS * mode]
    return np.hstack([_clay(vertices, model, camera, _SMALL) for vertices in faces])


@picture.register
def _(rig: Rig) -> Bytes | None:
    model = default_model()
    if len(rig.neutral) != len(model.mean):
        return None
    camera = _camera(rig.neutral, model, _SMALL)
    known = [weights for weights in ({}, *_EXPRESSIONS) if set(weights) <= set(rig.names)]
    return np.hstack([_clay(rig.vertices(weights), model, camera, _SMALL) for weights in known])


@picture.register
def _(parse: FaceParse) -> Bytes:
    table = np.array([_COLOURS[label] for label in FaceLabel], np.uint8)
    scale = min(1.0, _WIDEST / max(parse.labels.shape))
    size = [max(1, round(scale * side)) for side in parse.labels.shape[::-1]]
    return np.asarray(table[cv2.resize(parse.labels, size, interpolation=cv2.INTER_NEAREST)], np.uint8)


def _views(vertices: Floats, model: MorphableModel, yaw: float, pitch: float) -> Bytes:
    """As the picture shows the head, from the front, and from both sides."""
    turns = ((yaw, pitch), (0.0, 0.0), (40.0, 0.0), (-85.0, 0.0))
    return np.hstack([_clay(vertices, model, _camera(vertices, model, _TILE, *turn), _TILE) for turn in turns])


def _clay(vertices: Floats, model: MorphableModel, camera: Camera, size: int) -> Bytes:
    return render_mesh(Surface(vertices, model.faces), camera, size, shading="clay")


def _camera(
    vertices: Floats, model: MorphableModel, size: int, yaw: float = 0.0, pitch: float = 0.0
) -> ScaledOrthographicCamera:
    skin = vertices[model.region("skin")] if model.has("skin") else vertices
    low, high = skin.min(0), skin.max(0)
    extent = _HEADROOM * (high - low).max()
    return ScaledOrthographicCamera.look(yaw, pitch, size=size, centre=(low + high) / 2, extent=extent)
