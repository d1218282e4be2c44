"""The 68 landmarks of a frontal face, and how nearly given points form one."""

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

__all__ = ["FrontalLayout", "frontal_layout", "frontal_pose"]

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FrontalLayout:
    """A frontal face: ``points`` (68, 2), x right, y down; ``mirror`` (68,), partners on the other side; ``parts``."""

    points: _Floats
    mirror: NDArray[np.int64]
    parts: tuple[str, ...]


@cache
def frontal_layout() -> FrontalLayout:
    """The layout of ``landmark_layout.csv``."""
    text = files("toongeo.io").joinpath("landmark_layout.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return FrontalLayout(
        points=np.array([(float(row["x"]), float(row["y"])) for row in rows]),
        mirror=np.array([int(row["mirror"]) for row in rows]),
        parts=tuple(row["part"] for row in rows),
    )


def frontal_pose(points: _Floats, layout: _Floats) -> tuple[_Floats, float, float]:
    """Best orthogonal map layout -> points (2, 2), either handedness; misfits of the best rotation and reflection.

    Orthogonal Procrustes: for unit-norm centred shapes the best rotation explains the share (s1 +- s2)^2 of
    the spread, where s are the singular values of the 2x2 covariance and the sign is that of its
    determinant.
    """
    points = points - points.mean(axis=0)
    layout = layout - layout.mean(axis=0)
    # Unit size first: the square of a huge coordinate is not a number any more.
    points /= max(np.abs(points).max(), np.finfo(float).tiny)
    covariance = points.T @ layout / (np.linalg.norm(points) * np.linalg.norm(layout))
    u, (s1, s2), vt = np.linalg.svd(covariance)
    sign = 1.0 if np.linalg.det(u @ vt) > 0 else -1.0
    misfit, mirrored = (float(np.sqrt(max(0.0, 1 - (s1 + k * s2) ** 2))) for k in (sign, -sign))
    return u @ vt, misfit, mirrored
