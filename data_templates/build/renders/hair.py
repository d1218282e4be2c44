"""A shell of hair over the scalp, with a fringe or without, short or long."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from renders.canvas import between
from renders.template import template

__all__ = ["Hair", "hair_colours", "hair_shell"]

_ROWS, _COLUMNS = 24, 360  # of the table of strands: height by angle


@dataclass(frozen=True, eq=False)
class Hair:
    """`vertices` (n, 3) mm of the shell, one per vertex of the head, and `faces` (m, 3) into them; `long` hair falls
    behind the neck too."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    long: bool


def hair_shell(rng: np.random.Generator, vertices: NDArray[np.float64], normals: NDArray[np.float64]) -> Hair | None:
    """Hair for the head `vertices` (n, 3); None for one head in seven."""
    long = rng.random() < 0.4
    if rng.random() > 0.85:
        return None
    part = template()
    angle, height = part.angles, part.model.mean[:, 1]
    fringe = rng.random() > 0.65
    middle = between(rng, 14, 48) if fringe else between(rng, 48, 74)  # mm above the eyes
    waves, phase = between(rng, 2, 14), between(rng, 0, 6)
    line = middle + rng.normal(0, 14) * angle + between(rng, 0, 7) * np.sin(3 * waves * angle + phase)
    temple = between(rng, 0.75, 1.25)  # rad, where the hair line goes down
    low = between(rng, -150, -60) if long else between(rng, -20, 20)
    side = 1 / (1 + np.exp(-(np.abs(angle) - temple) / 0.08))
    above = height - (line * (1 - side) + low * side)
    inside = (above > -3) | ((part.model.mean[:, 2] < -60) & (height > between(rng, -90, -40)))
    if not long and rng.random() < 0.6:
        inside &= ~part.model.region("ears")
    faces = part.shell_faces[inside[part.shell_faces].all(1)]
    thick = between(rng, 2, 12) if rng.random() < 0.5 else between(rng, 8, 38)
    crown = 1 + np.clip((height - 20) / 80, 0, 1) * between(rng, 0, 1)
    curls = 1 + 0.35 * np.sin(angle * between(rng, 2, 9) + phase) * np.cos(height * between(rng, 0.01, 0.06))
    rise = np.clip((above + 3) / between(rng, 4, 30), 0.06, 1)  # thin at the hair line
    return Hair(vertices + normals * (thick * crown * curls * rise)[:, None], faces, long)


def hair_colours(
    rng: np.random.Generator, colour: NDArray[np.float64], angle: NDArray, height: NDArray, plain: bool
) -> NDArray[np.float64]:
    """Colours (k, 3) of strands at an angle (rad) about the head and a height (mm); `plain` hair often has none."""
    strands = rng.normal(size=(_ROWS, _COLUMNS)).astype(np.float32)
    strands = cv2.GaussianBlur(strands, (0, 0), sigmaX=between(rng, 0.4, 1.6), sigmaY=between(rng, 2, 6))
    strands /= strands.std()
    across = 90 * angle + between(rng, 0, 12) * np.sin(height * between(rng, 0.02, 0.08))
    row = np.clip(((height + 190) / 13).astype(int), 0, _ROWS - 1)
    column = ((across + 400) * 0.45).astype(int) % _COLUMNS
    strength = between(rng, 0, 0.45) * (not plain or rng.random() < 0.3)
    sheen = 1 + between(rng, 0, 0.5) * np.exp(-0.5 * ((height - between(rng, 40, 90)) / 9) ** 2) * (rng.random() < 0.4)
    return colour * (np.clip(1 + strands[row, column] * strength, 0.3, 2) * sheen)[:, None]
