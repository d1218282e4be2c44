"""How each style bends a face, as data."""

import csv
from dataclasses import dataclass
from functools import cache

import numpy as np

from toongeo._data_path import data_path
from toongeo.arrays import Floats

__all__ = ["WarpRule", "style_rules"]


@dataclass(frozen=True)
class WarpRule:
    """Scales and shifts what lies around some landmarks; lengths in face sizes, in the face's frame.

    Attributes
    ----------
    points : tuple of int
        Landmarks whose mean, moved by ``offset``, is the centre.
    scale, shift, reach, offset : (across, down)
        Beyond the ellipse with half axes ``reach`` nothing moves.
    """

    points: tuple[int, ...]
    scale: tuple[float, float]
    shift: tuple[float, float]
    reach: tuple[float, float]
    offset: tuple[float, float]

    def velocity(self, at: Floats, landmarks: Floats) -> Floats:
        """Velocity (..., 2) at points (..., 2) of the frame, for a face with these landmarks (68, 2) in the frame.

        At the centre it is that of a scaling; a C2 bump ends it at the rim: ``bump(|q| / reach) (ln scale q + shift)``.
        """
        q = at - (landmarks[list(self.points)].mean(axis=0) + self.offset)
        inside = np.clip(1 - np.hypot(q[..., 0] / self.reach[0], q[..., 1] / self.reach[1]), 0, 1)
        bump = inside**3 * (10 - 15 * inside + 6 * inside**2)
        return np.asarray(bump[..., None] * (np.log(self.scale) * q + self.shift))


@cache
def style_rules() -> dict[str, tuple[WarpRule, ...]]:
    """Rules of each style, from ``data_templates/style_rules.csv``."""
    with open(data_path("data_templates/style_rules.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    styles: dict[str, tuple[WarpRule, ...]] = {}
    for row in rows:
        pairs = {
            name: (float(row[f"{name}_x"]), float(row[f"{name}_y"])) for name in ("scale", "shift", "reach", "offset")
        }
        styles[row["style"]] = (*styles.get(row["style"], ()), WarpRule(_points(row["points"]), **pairs))
    return styles


def _points(text: str) -> tuple[int, ...]:
    """Landmarks of ``"30 31"`` or ``"36-41"``."""
    ends = [part.split("-") for part in text.split()]
    return tuple(index for end in ends for index in range(int(end[0]), int(end[-1]) + 1))
