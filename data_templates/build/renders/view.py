"""A random camera, and where it sees the 68 landmarks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from renders.canvas import between
from renders.template import template

__all__ = ["View", "random_view"]

_YAW, _PITCH, _ROLL = 60.0, 28.0, 40.0  # degrees at most


@dataclass(frozen=True, eq=False)
class View:
    """A perspective camera: `rotation` (3, 3) about `centre` (3,) mm, `distance` mm from it, `scale` px/mm there,
    `offset` (2,) px of the centre; `yaw` in degrees, > 0 to the subject's left."""

    rotation: NDArray[np.float64]
    centre: NDArray[np.float64]
    distance: float
    scale: float
    offset: NDArray[np.float64]
    yaw: float

    def projected(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 3): x, y in px and the depth towards the viewer in mm of model-frame points (k, 3)."""
        seen = (points - self.centre) @ self.rotation.T
        nearness = self.distance / (self.distance - seen[:, 2])
        flat = self.offset + seen[:, :2] * [self.scale, -self.scale] * nearness[:, None]
        return np.column_stack([flat, seen[:, 2]])


def random_view(
    rng: np.random.Generator, head: NDArray[np.float64], normals: NDArray[np.float64], size: int, extent
) -> tuple[View, NDArray[np.int64]]:
    """A camera for a picture of `size` px, and the vertices (68,) where it sees the landmarks of the head.

    The points' root mean square distance from their middle is `extent` (low, high) of the picture's size.
    """
    broad = rng.random() < 0.15
    yaw = between(rng, -_YAW, _YAW) if broad else float(np.clip(rng.normal(0, 20), -_YAW, _YAW))
    pitch, roll = np.clip(rng.normal(0, 10), -_PITCH, _PITCH), np.clip(rng.normal(0, 11), -_ROLL, _ROLL)
    rotation = _rotation(*np.radians([yaw, pitch, roll]))
    rows = _visible_landmarks(normals, rotation)
    centre, distance = head[rows].mean(0), between(rng, 350, 1600)
    flat = View(rotation, centre, distance, 1.0, np.zeros(2), yaw).projected(head[rows])[:, :2]
    spread = np.sqrt(((flat - flat.mean(0)) ** 2).sum(1).mean())
    scale = size * between(rng, *extent) / spread
    offset = np.array([0.5, 0.53]) * size + rng.normal(0, 0.015 * size, 2)
    return View(rotation, centre, distance, scale, offset, yaw), rows


def _visible_landmarks(normals: NDArray[np.float64], rotation: NDArray[np.float64]) -> NDArray[np.int64]:
    """Jaw points lie where their contour line turns away from the viewer, but not behind where it may end."""
    part = template()
    rows = part.model.landmarks.copy()
    for k, line in enumerate(part.model.contour_lines):
        turned = normals[line] @ rotation[2] <= 0
        first = int(turned.argmax()) if turned.any() else len(line) - 1
        rows[k] = line[min(first, part.jaw_last[k])]
    return rows


def _rotation(yaw: float, pitch: float, roll: float) -> NDArray[np.float64]:
    (cy, cp, cr), (sy, sp, sr) = np.cos([yaw, pitch, roll]), np.sin([yaw, pitch, roll])
    turn = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    nod = np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]])
    tilt = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
    return tilt @ nod @ turn
