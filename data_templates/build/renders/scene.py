"""A head before a background, lit, with its landmarks and the parts of the picture, before it is drawn in a style."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import cv2
import numpy as np
from numpy.typing import NDArray

from renders.accessories import paint_glasses, paint_hand, paint_hat
from renders.canvas import Canvas, between
from renders.hair import hair_colours, hair_shell
from renders.palette import Palette, random_palette
from renders.random_head import Head, random_head
from renders.shading import Surface, shaded
from renders.skin_paint import painted_skin
from renders.surroundings import background, paint_back_hair, paint_clothes
from renders.template import template
from renders.view import View, random_view
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.render.rasterize import rasterize

__all__ = ["Part", "Scene", "random_scene"]


class Part(IntEnum):
    """What a pixel of a render shows."""

    BACKGROUND = 0
    SKIN = 1  # with ears and neck
    EYE = 2
    MOUTH = 3  # its inside, with the teeth
    HAIR = 4  # on the head; a shaved or painted scalp is skin
    CLOTHES = 5
    HAT = 6
    GLASSES = 7
    HAND = 8


_SHINE = np.array([0, 70, 160, 30, 60, 0, 0, 0, 0])  # of the highlight on each part, at most


@dataclass(frozen=True, eq=False)
class Scene:
    """`picture` (s, s, 3) float32, 0-255; `landmarks` (68, 2) px; `parts` (s, s) uint8 of :class:`Part`; `edges`
    (s, s) float32 in [0, 1] where an artist would draw a line; the `kind` of head, its `yaw` in degrees; `plain` if its
    colours are flat, `lined` if its features are drawn with lines already."""

    picture: NDArray[np.float32]
    landmarks: NDArray[np.float64]
    parts: NDArray[np.uint8]
    edges: NDArray[np.float32]
    kind: str
    yaw: float
    plain: bool
    lined: bool = False


@dataclass(frozen=True, eq=False)
class _Model:
    """All that is rendered: `vertices` and `normals` (n, 3), `faces` (m, 3), and their `parts` (m,)."""

    vertices: NDArray[np.float64]
    normals: NDArray[np.float64]
    faces: NDArray[np.int64]
    parts: NDArray[np.uint8]
    long_hair: bool | None


def random_scene(
    rng: np.random.Generator,
    kind: str,
    plain: bool = False,
    size: int = 256,
    extent=(0.155, 0.195),
    head: Head | None = None,
) -> Scene:
    """A scene with a head of a kind (see `random_head.KINDS`), unless one is given; `plain` ones have flat colours and
    light.

    `extent` is the range of the landmarks' root mean square radius as a share of the size.
    """
    count, palette = len(template().model.mean), random_palette(rng)
    head = head or random_head(rng, kind)
    chart, brows = painted_skin(rng, palette, plain)
    model = _assembled(rng, head)
    view, rows = random_view(rng, head.vertices[:count], model.normals[:count], size, extent)
    points = head.vertices[rows]
    lifted = template().lifted(brows, head.vertices[:count])
    found = np.isfinite(lifted).all(1)
    points[17:27][found] = lifted[found]
    landmarks, flat = view.projected(points)[:, :2], view.projected(model.vertices)
    fragments = rasterize(flat, model.faces, size, size, cull_back=True)
    surface = _surface(rng, view, model, fragments, flat)
    shown = model.parts[surface.face_ids]
    colours = _colours(rng, palette, chart, head, surface, shown, plain, model.long_hair is not None)
    picture, parts = background(rng, size), np.zeros((size, size), np.uint8)
    canvas = Canvas(picture, parts)
    if model.long_hair or (model.long_hair is False and rng.random() < 0.2):
        scalp = template().model.region("scalp")
        paint_back_hair(rng, canvas, flat[:count, :2], scalp, palette.hair, Part.HAIR)
    picture[surface.mask] = shaded(rng, colours, surface, plain)
    parts[surface.mask] = shown
    edges = _edges(rng, surface, parts)
    _dress(rng, canvas, landmarks, flat[:count][template().model.region("neck"), :2], palette)
    if kind == "cartoon" and rng.random() < 0.5:
        _paint_glints(rng, canvas, landmarks)
    return Scene(np.clip(picture, 0, 255), landmarks, parts, edges, kind, view.yaw, plain)


def _assembled(rng: np.random.Generator, head: Head) -> _Model:
    """Head, eyeballs and hair in one mesh."""
    part = template()
    count = len(part.model.mean)
    normals = vertex_normals(head.vertices, part.faces)
    labels = np.full(len(part.model.faces), Part.SKIN, np.uint8)
    labels[part.in_mouth] = Part.MOUTH
    labels = np.concatenate([labels, np.full(len(part.eye_faces), Part.EYE, np.uint8)])
    hair = hair_shell(rng, head.vertices[:count], normals[:count])
    if hair is None:
        return _Model(head.vertices, normals, part.faces, labels, None)
    vertices = np.vstack([head.vertices, hair.vertices])
    faces = np.vstack([part.faces, hair.faces + len(head.vertices)])
    labels = np.concatenate([labels, np.full(len(hair.faces), Part.HAIR, np.uint8)])
    return _Model(vertices, vertex_normals(vertices, faces), faces, labels, hair.long)


def _surface(rng, view: View, model: _Model, fragments, flat) -> Surface:
    mask = fragments.mask
    face_ids, weights = fragments.face_ids[mask], fragments.barycentrics[mask]
    corners = model.faces[face_ids]
    normals = np.einsum("pk,pkc->pc", weights, (model.normals @ view.rotation.T).astype(np.float32)[corners])
    normals /= np.maximum(np.sqrt(np.einsum("pc,pc->p", normals, normals)), 1e-6)[:, None]
    depth = np.zeros(mask.shape, np.float32)
    depth[mask] = np.einsum("pk,pk->p", weights, flat[:, 2].astype(np.float32)[corners])
    depth[~mask] = depth[mask].min()
    shine = (_SHINE * rng.uniform(0, 1, len(Part))).astype(np.float32)[model.parts[face_ids]]
    seen = (model.vertices - view.centre) @ view.rotation.T
    casting = model.faces[model.parts != Part.EYE]
    return Surface(mask, face_ids, normals, corners, weights, shine, depth, seen, casting)


def _colours(rng, palette: Palette, chart, head: Head, surface: Surface, shown, plain, hairy) -> NDArray[np.float32]:
    """Unlit colours (k, 3) of the surface's pixels."""
    part, corners, weights = template(), surface.corners, surface.weights
    colours = np.zeros((len(shown), 3), np.float32)
    on_head = (shown == Part.SKIN) | (shown == Part.MOUTH)
    rows, face_ids = corners[on_head], surface.face_ids[on_head]
    place = np.einsum("pk,pkc->pc", weights[on_head], part.chart[rows])
    x, y = np.clip(np.rint(place).astype(int), 0, np.array(part.chart_shape)[::-1] - 1).T
    skin = chart[y, x]
    inner = part.inner[face_ids]
    skin[inner] = part.model.albedo_mean[rows[inner]].mean(1) * 255
    for region, colour in (
        (part.sockets, palette.skin * 0.8),
        (part.cavity, np.array([70, 22, 25]) * between(rng, 0.3, 1)),
        (part.teeth, np.array([1, 0.98, 0.93]) * between(rng, 170, 250)),
    ):
        skin[region[face_ids]] = colour
    if not hairy or rng.random() < 0.5:  # a shaved head
        scalp, amount = part.scalp[face_ids], between(rng, 0, 1)
        skin[scalp] += amount * (palette.hair - skin[scalp])
    colours[on_head] = skin
    eye = shown == Part.EYE
    colours[eye] = _eye_colours(rng, palette, head, np.einsum("pk,pk->p", weights[eye], head.gaze_angles[corners[eye]]))
    hair = shown == Part.HAIR
    if hair.any():
        rows = corners[hair] - len(head.vertices)
        angle, height = (np.einsum("pk,pk->p", weights[hair], v[rows]) for v in (part.angles, part.model.mean[:, 1]))
        colours[hair] = hair_colours(rng, palette.hair, angle, height, plain)
    return colours


def _eye_colours(rng, palette: Palette, head: Head, angle: NDArray) -> NDArray[np.float64]:
    """Sclera, iris, limbus and pupil by the angle (k,) rad from the pupil's middle."""
    eye = template().model.eyes[0]
    iris, pupil = eye.iris_angle * head.iris_scale, eye.pupil_angle * between(rng, 0.8, 1.6) * head.iris_scale
    colours = np.empty((len(angle), 3))
    colours[:] = between(rng, 190, 252) * np.array([1, 0.98, 0.96])
    colours[angle < iris] = palette.iris
    colours[(angle < iris) & (angle > 0.88 * iris)] = palette.iris * between(rng, 0.2, 0.8)
    colours[angle < pupil] = 8
    return colours


def _edges(rng, surface: Surface, parts: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Creases, outlines and borders of parts."""
    normals = np.zeros((*surface.mask.shape, 3), np.float32)
    normals[surface.mask] = surface.normals
    slopes = (cv2.Sobel(normals, cv2.CV_32F, *order) for order in ((1, 0), (0, 1)))
    steps = sum(np.sqrt(np.einsum("yxc,yxc->yx", slope, slope)) for slope in slopes)
    borders = cv2.morphologyEx(parts, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    jumps = np.abs(cv2.Laplacian(surface.depth, cv2.CV_32F, ksize=3)) > between(rng, 8, 30)
    return (jumps | borders | (steps > between(rng, 2.5, 6))).astype(np.float32)


def _dress(rng, canvas: Canvas, landmarks: NDArray[np.float64], neck: NDArray[np.float64], palette: Palette) -> None:
    if rng.random() < 0.85:
        paint_clothes(rng, canvas, neck, Part.CLOTHES)
    if rng.random() < 0.07:
        paint_hat(rng, canvas, landmarks, Part.HAT)
    if rng.random() < 0.13:
        paint_glasses(rng, canvas, landmarks, Part.GLASSES)
    if rng.random() < 0.04:
        paint_hand(rng, canvas, landmarks, palette.skin, Part.HAND)


def _paint_glints(rng, canvas: Canvas, landmarks: NDArray[np.float64]) -> None:
    share = between(rng, 0.05, 0.16)
    for first in (36, 42):
        eye = landmarks[first : first + 6]
        wide = np.linalg.norm(eye[3] - eye[0])
        canvas.ellipse(eye.mean(0) - 0.12 * wide, (share * wide, share * wide), (255, 255, 255))
