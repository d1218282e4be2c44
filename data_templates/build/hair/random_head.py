"""A random head in a random pose, as maps of its pixels, without hair."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from noise import Floats, Rng, chance
from numpy.typing import NDArray

from toongeo.geometry import vertex_normals
from toongeo.model import MorphableModel
from toongeo.render import ScaledOrthographicCamera, interpolate, rasterize

__all__ = ["Head", "random_head"]

Mask = NDArray[np.bool_]

AXIS = -80.0  # mm: z of the vertical axis about which directions on the head are measured


@dataclass(frozen=True, eq=False)
class Head:
    """Pixels of a head.

    Attributes
    ----------
    landmarks : (68, 2) float64 px
    seen : (h, w) bool
    face, scalp, ears, neck, skull : (h, w) bool
        Its parts; skull: head without ears and neck.
    colour : (h, w, 3) float32
        Albedo, sRGB 0-255.
    normal : (h, w, 3) float32
        Camera frame.
    depth : (h, w) float32, mm
        Towards the viewer; lowest off the head.
    turn, height : (h, w) float32
        Direction about the head's axis (rad, 0 in front) and height (mm) of the template's surface at the pixel.
    across, up : (h, w) float32
        Head frame in the picture: from the middle of the skull, in sizes of the skull.
    middle : (2,) float64 px
    upright : (2,) float64
        Direction of the crown in the picture.
    size : float px
        Height of the skull, chin to crown.
    """

    landmarks: NDArray[np.float64]
    seen: Mask
    face: Mask
    scalp: Mask
    ears: Mask
    neck: Mask
    skull: Mask
    colour: Floats
    normal: Floats
    depth: Floats
    turn: Floats
    height: Floats
    across: Floats
    up: Floats
    middle: NDArray[np.float64]
    upright: NDArray[np.float64]
    size: float

    def place(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Pixels (k, 2) of points (across, up) in the head frame."""
        points = np.asarray(points, float)
        right = np.array([-self.upright[1], self.upright[0]])
        return self.middle + self.size * (points[:, :1] * right + points[:, 1:] * self.upright)


def random_head(rng: Rng, model: MorphableModel, side: int, exaggeration: float) -> Head:
    """A person (exaggeration 0) or a caricature (up to 1) in a square picture."""
    V = _shape(rng, model, exaggeration)
    yaw, pitch, roll = np.clip(rng.normal(0, [19, 8, 9]), [-48, -22, -28], [48, 22, 28])
    R = ScaledOrthographicCamera.look(yaw, pitch, roll).rotation
    flat = V @ R.T
    skin = model.region("skin") | model.region("scalp")
    extent = np.ptp(flat[skin, 1])
    scale = side * rng.uniform(0.34, 0.5) / max(extent, np.ptp(flat[skin, 0]))
    centre = (flat[skin].max(0) + flat[skin].min(0))[:2] / 2
    aim = side * (np.array([0.5, 0.46]) + rng.normal(0, 0.02, 2))
    camera = ScaledOrthographicCamera(scale, R, aim - scale * centre * [1, -1])
    return _maps(rng, model, V, camera, side)


def _shape(rng: Rng, model: MorphableModel, exaggeration: float) -> NDArray[np.float64]:
    principal = model.prior.n_principal
    identity = np.zeros(len(model.identity))
    identity[:principal] = model.prior.mean[:principal] * rng.uniform(0, 1) + rng.normal(
        0, 0.8 + exaggeration, principal
    )
    weights = np.zeros(len(model.expression))
    weights[rng.choice(model.n_named, 4, replace=False)] = rng.uniform(0, 0.7, 4) * (rng.random(4) < 0.5)
    V = model.mean + np.tensordot(identity, model.identity, 1) + np.tensordot(weights, model.expression, 1)
    spread = 0.05 + 0.22 * exaggeration
    for centre, reach in (((0, 75, -60), 65), ((0, -100, 10), 45), ((0, -30, 40), 28)):  # cranium, chin, nose
        away = V - centre
        near = np.exp(-0.5 * (away**2).sum(1, keepdims=True) / reach**2)
        V = V + near * away * (np.exp(rng.normal(0, spread, 3) + rng.normal(0, spread)) - 1)
    for name in ("ear_left", "ear_right"):
        centre = V[model.region(name)].mean(0)
        near = np.exp(-0.5 * ((V - centre) ** 2).sum(1, keepdims=True) / 26.0**2)
        V = V + near * (V - centre) * (np.exp(rng.normal(0, 1.3 * spread)) - 1)
    taper = 1 + rng.normal(0, 0.8 * spread) * np.clip(V[:, 1:2] / 110, -1.2, 1.0)
    return V * [1, np.exp(rng.normal(0, 0.7 * spread)), 1] * np.hstack([taper, np.ones_like(taper), taper])


def _maps(rng: Rng, model: MorphableModel, V, camera, side: int) -> Head:
    px, depth = camera.project(V), camera.depth(V)
    seen = rasterize(np.column_stack([px, depth]), model.faces, side, side)
    normals = vertex_normals(V, model.faces)
    mean = model.mean
    turn = np.arctan2(mean[:, 0], mean[:, 2] - AXIS)
    albedo = model.albedo_mean + np.tensordot(rng.normal(0, 1, len(model.albedo)), model.albedo, 1)
    values = np.column_stack([turn, mean[:, 1], normals @ camera.rotation.T, np.clip(albedo, 0, 1) * 255, depth])
    # The seam of the directions lies behind: pixels that cross it are behind too.
    maps = interpolate(seen, model.faces, values.astype(np.float32))
    part = {
        name: np.append(model.region(name)[model.faces].all(1), False)[seen.face_ids]
        for name in ("face", "scalp", "ears", "neck")
    }
    keep = (model.region("skin") | model.region("scalp")) & ~model.region("ears")
    skull = rasterize(px, model.faces[keep[model.faces].all(1)], side, side).mask & ~part["neck"]
    upright = np.array([1.0, -1.0]) * camera.rotation[:2, 1]
    upright = upright / np.linalg.norm(upright)
    ys, xs = np.nonzero(skull)
    points = np.column_stack([xs, ys])
    along, aside = points @ upright, points @ [-upright[1], upright[0]]
    size = float(np.ptp(along))
    high = along > along.max() - 0.5 * size
    middle = upright * (along.max() - 0.38 * size) + np.array([-upright[1], upright[0]]) * aside[high].mean()
    y, x = np.mgrid[:side, :side].astype(np.float32)
    dx, dy = (x - middle[0]) / size, (y - middle[1]) / size
    return Head(
        landmarks=px[_landmarks(model, normals, camera)],
        seen=seen.mask,
        **part,
        skull=skull,
        colour=maps[..., 5:8],
        normal=maps[..., 2:5] / np.maximum(np.linalg.norm(maps[..., 2:5], axis=2, keepdims=True), 1e-6),
        depth=np.where(seen.mask, maps[..., 8], depth.min()).astype(np.float32),
        turn=maps[..., 0],
        height=maps[..., 1],
        across=(-upright[1] * dx + upright[0] * dy).astype(np.float32),
        up=(upright[0] * dx + upright[1] * dy).astype(np.float32),
        middle=middle,
        upright=upright,
        size=size,
    )


def _landmarks(model: MorphableModel, normals, camera) -> NDArray[np.int64]:
    """The 68 vertices; jaw points slide along their lines to the visible outline."""
    rows = model.landmarks.copy()
    facing = normals @ camera.rotation[2]
    for k, line in enumerate(model.contour_lines):
        turned = facing[line] <= 0
        last = len(line) - 1
        if k <= 4 or k >= 12:  # annotators stop before the ear
            last = int(np.flatnonzero(model.mean[line, 2] >= model.mean[rows[k], 2] + 18).max(initial=0))
        rows[k] = line[min(int(turned.argmax()) if turned.any() else len(line) - 1, last)]
    return rows


def paint_features(rng: Rng, img: Floats, head: Head, hair: Floats) -> None:
    """Eyes, brows, a line of the mouth and perhaps glasses, in place."""
    points = head.landmarks
    unit = float(np.linalg.norm(points[36] - points[45]))
    fixed = lambda p: np.rint(np.asarray(p) * 16).astype(np.int32)  # noqa: E731
    for rows in (range(36, 42), range(42, 48)):
        eye = points[list(rows)]
        cv2.fillPoly(img, [fixed(eye)], (240.0, 240.0, 238.0), cv2.LINE_AA, 4)
        middle, radius = eye.mean(0) + rng.normal(0, 0.01 * unit, 2), unit * rng.uniform(0.045, 0.08)
        iris = tuple(float(c) for c in rng.uniform(10, 130, 3))
        cv2.circle(img, tuple(int(c) for c in fixed(middle)), int(radius * 16), iris, -1, cv2.LINE_AA, 4)
        cv2.polylines(img, [fixed(eye[:4])], False, (30.0, 22.0, 20.0), int(rng.integers(1, 4)), cv2.LINE_AA, 4)
    if chance(rng, 0.7):
        mouth = points[[*range(48, 55), *range(59, 54, -1)]][[0, 1, 2, 3, 4, 5, 6, 11, 10, 9, 8, 7]]
        lips = tuple(
            float(c) for c in np.median(img[head.face], axis=0) * rng.uniform([0.7, 0.35, 0.4], [1.0, 0.8, 0.8])
        )
        cv2.fillPoly(img, [fixed(mouth)], lips, cv2.LINE_AA, 4)
    for nostril in points[[32, 34]] + rng.normal(0, 0.01 * unit, (2, 2)):
        x, y = fixed(nostril)
        cv2.circle(
            img, (int(x), int(y)), int(rng.uniform(0.01, 0.05) * unit * 16), (40.0, 25.0, 22.0), -1, cv2.LINE_AA, 4
        )
    brow = tuple(float(c) for c in hair * rng.uniform(0.5, 1.0))
    for rows in (range(17, 22), range(22, 27)):
        line = points[list(rows)]
        cv2.polylines(img, [fixed(line)], False, brow, max(1, int(unit * rng.uniform(0.02, 0.09))), cv2.LINE_AA, 4)
    cv2.polylines(img, [fixed(points[60:65])], False, (90.0, 40.0, 40.0), 1, cv2.LINE_AA, 4)
    if chance(rng, 0.14):
        frame = tuple([float(rng.choice([15, 60, 130]))] * 3)
        for rows in (range(36, 42), range(42, 48)):
            middle = tuple(int(c) for c in points[list(rows)].mean(0))
            axes = int(unit * rng.uniform(0.2, 0.27)), int(unit * rng.uniform(0.12, 0.22))
            if chance(rng, 0.3):
                cv2.ellipse(img, middle, axes, 0, 0, 360, (25.0, 20.0, 20.0), -1, cv2.LINE_AA)
            cv2.ellipse(img, middle, axes, 0, 0, 360, frame, int(rng.integers(1, 5)), cv2.LINE_AA)
