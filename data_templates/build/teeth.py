"""Two rows of teeth for the default head, built on the plain dental strips of the base mesh.

The strips give the dental arch, its height and its position; the crowns are added here. Each jaw is one quad
cage of 43 columns by 8 rows, meant for Catmull-Clark: seven teeth a side, three columns a tooth (a pinched
contact and two columns on the crown); the rows run from the outer gum over the crown and the biting edge to
the inner gum.

``tooth_sizes.csv`` holds the sizes and says which were measured and which chosen, ``teeth_strips.csv`` names
the vertices of the strips. All lengths are scaled to the strips, so any unit will do.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_HERE = Path(__file__).parent
_STRIP = 68  # vertices of a strip
_ROWS = 8  # outer gum, gum margin, neck, crown, outer edge, inner edge, inner neck, inner gum
_TEETH, _COLUMNS = 7, 22  # a side: three columns a tooth, and the midline
# chosen by eye
_ARCH_SHARE = 0.90  # of the strip's length that the upper teeth fill: the strip runs on behind the molars
_OVERJET = (2.3, 0.9)  # mm the lower teeth stand behind the upper ones, front and back
_REST = 1.4  # mm each row stands back from the bite, as in a jaw at rest: closed lips show no incisor
_EDGE_LOSS = 0.08  # share of the crown that one Catmull-Clark step rounds off the edge


@dataclass(frozen=True, eq=False)
class _Arch:
    """One side of a strip as smooth curves of the arc length along its biting edge."""

    length: float
    x: Array  # coefficients of odd powers of s / length
    z: Array  # coefficients of even powers, as below
    y: Array
    gum_height: Array
    gum_offset: Array  # how far the gum stands outside the biting edge

    def point(self, s: Array) -> tuple[Array, Array, Array]:
        """Positions ``(n, 3)`` on the biting edge, and height and offset of the gum ``(n,)`` there."""
        t = s / self.length
        x = _powers(t, 1, len(self.x)) @ self.x
        xyz = np.column_stack([x, self._even(t, self.y), self._even(t, self.z)])
        return xyz, self._even(t, self.gum_height), self._even(t, self.gum_offset)

    def outward(self, s: Array) -> Array:
        """Unit vectors ``(n, 3)`` in the horizontal plane, away from the tongue."""
        step = 1e-4 * self.length
        tangent = self.point(s + step)[0] - self.point(s - step)[0]
        n = np.column_stack([-tangent[:, 2], np.zeros(len(s)), tangent[:, 0]])
        return n / np.linalg.norm(n, axis=1, keepdims=True)

    @staticmethod
    def _even(t: Array, coefficients: Array) -> Array:
        return _powers(t, 0, len(coefficients)) @ coefficients


def _powers(t: Array, first: int, count: int) -> Array:
    return t[:, None] ** (first + 2 * np.arange(count))


def _table(name: str) -> Iterator[dict[str, str]]:
    with open(_HERE / name, encoding="utf-8", newline="") as file:
        yield from csv.DictReader(line for line in file if not line.startswith("#"))


def _arch(strip: Array, jaw: str) -> _Arch:
    table = {r["row"]: r["vertices"].split() for r in _table("teeth_strips.csv") if r["jaw"] == jaw}
    edge, gum = (strip[np.array(table[row], int)] for row in ("edge", "gum"))
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(edge[:, [0, 2]], axis=0), axis=1))])
    t = s / s[-1]

    def fit(values: Array, first: int, count: int) -> Array:
        return np.asarray(np.linalg.lstsq(_powers(t, first, count), values, rcond=None)[0], np.float64)

    x, z = fit(edge[:, 0], 1, 3), fit(edge[:, 2], 0, 4)
    bare = _Arch(float(s[-1]), x, z, fit(edge[:, 1], 0, 3), np.zeros(1), np.zeros(1))
    flare = np.einsum("ij,ij->i", gum - edge, bare.outward(s))
    return _Arch(bare.length, x, z, bare.y, fit(np.abs(gum[:, 1] - edge[:, 1]), 0, 3), fit(flare, 0, 3))


def _columns(jaw: str, scale: float) -> dict[str, Array]:
    """Per column of one side, midline first: place and sizes of its tooth (the mean of two at a contact)."""
    teeth = [r for r in _table("tooth_sizes.csv") if r["jaw"] == jaw]
    size = {k: np.array([float(r[k]) for r in teeth]) for k in teeth[0] if k not in ("jaw", "tooth")}
    shoulder = size.pop("shoulder")
    size = {k: scale * v for k, v in size.items()}
    start = np.concatenate([[0.0], np.cumsum(size["width"])])
    s = np.zeros(_COLUMNS)
    s[0::3] = start
    s[1::3] = start[:-1] + shoulder * size["width"]
    s[2::3] = start[:-1] + (1 - shoulder) * size["width"]
    out = {"s": s}
    for key in ("height", "edge", "neck", "bulge", "tip"):
        column = np.zeros(_COLUMNS)
        column[1::3] = column[2::3] = size[key]
        # a contact takes after both its teeth
        padded = np.concatenate([size[key][:1], size[key], size[key][-1:]])
        column[0::3] = 0.5 * (padded[:-1] + padded[1:])
        out[key] = column
    out["notch"] = np.zeros(_COLUMNS)
    out["notch"][0::3] = np.concatenate([0.8 * size["notch"][:1], size["notch"]])
    return out


def _profile(c: dict[str, Array], gum_height: Array, flare: Array, scale: float) -> tuple[Array, Array]:
    """The section through each column: height above the bite and outward offset of the rows, (8, columns)."""
    notch, crown = c["notch"], c["height"]
    pinch = np.where(notch > 0, 1.0, 0.0) * scale
    rest = _REST * scale
    tip = -c["tip"] - _EDGE_LOSS * crown
    lean = np.clip(flare / gum_height, -0.6, 0.6)  # the strips lean: their gum stands outside their edge
    papilla = 2.2 * pinch  # the gum fills the gap between two necks
    height = [
        np.maximum(gum_height - rest, crown + 4.0 * scale),
        crown + 1.1 * scale - papilla,
        crown - 0.6 * scale - papilla,
        0.55 * crown,
        tip + 1.0 * notch,
        tip + 1.0 * notch + 0.15 * scale,
        0.6 * crown,
        0.85 * crown + 3.0 * scale,
    ]
    offset = [
        lean * height[0],
        lean * height[1] + 0.75 * scale - 0.3 * pinch,
        lean * height[2] + 0.1 * scale - 0.9 * pinch,
        lean * height[3] + c["bulge"] - 2.0 * pinch - c["bulge"] * np.where(pinch > 0, 0.6, 0.0),
        -1.0 * pinch,
        -c["edge"] + 0.4 * pinch,
        -c["neck"] + 1.4 * pinch,
        -c["neck"] - 1.5 * scale,
    ]
    return np.stack(height) + rest, np.stack(offset)


def _jaw_vertices(strip: Array, jaw: str, scale: float) -> Array:
    """One side of a jaw, ``(8, columns, 3)``, the midline (x = 0 exactly) first."""
    arch = _arch(strip, jaw)
    c = _columns(jaw, scale)
    point, gum_height, flare = arch.point(c["s"])
    height, offset = _profile(c, gum_height, flare, scale)
    if jaw == "lower":
        share = c["s"] / c["s"][-1]
        offset = offset - scale * (_OVERJET[0] * (1 - share) + _OVERJET[1] * share)
    up = 1.0 if jaw == "upper" else -1.0
    v = point + offset[..., None] * arch.outward(c["s"]) + up * height[..., None] * np.array([0.0, 1.0, 0.0])
    v[:, 0, 0] = 0.0
    return v


def _jaw_quads(jaw: str) -> Index:
    """The cage's grid, and three quads that close each end behind the last molar."""
    width = 2 * _COLUMNS - 1
    grid = np.arange(_ROWS * width).reshape(_ROWS, width)
    quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], -1).reshape(-1, 4)
    r = np.arange(_ROWS // 2 - 1)
    left, right = grid[:, -1], grid[:, 0]
    ends = [np.stack([e[r], e[-1 - r], e[-2 - r], e[r + 1]], -1) for e in (left, right)]
    quads = np.vstack([quads, ends[0], ends[1][:, ::-1]])
    # walking along +X and then towards the bite is counter-clockwise from outside for the lower jaw only
    return quads[:, ::-1].copy() if jaw == "upper" else quads


def _jaw_uv(vertices: Array) -> Array:
    """u along the arch, v from outer to inner gum; the end columns bow in to leave room for the ends."""
    profile = np.linalg.norm(np.diff(vertices, axis=0), axis=2).mean(1)
    v = np.concatenate([[0.0], np.cumsum(profile)]) / profile.sum()
    run = np.linalg.norm(np.diff(vertices[3], axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(run)]) / run.sum()
    u = 0.5 * np.broadcast_to(s, (_ROWS, _COLUMNS)).copy()
    u[:, -1] -= 0.35 * (u[0, -1] - u[0, -2]) * np.sin(np.pi * v)
    right = np.stack([0.5 - u[:, :0:-1], np.broadcast_to(v[:, None], (_ROWS, _COLUMNS - 1))], -1)
    left = np.stack([0.5 + u, np.broadcast_to(v[:, None], (_ROWS, _COLUMNS))], -1)
    return np.concatenate([right, left], 1).reshape(-1, 2)


def teeth_quads(upper_strip_vertices: Array, lower_strip_vertices: Array) -> dict[str, NDArray]:
    """Quad cages of both rows of teeth.

    Parameters
    ----------
    upper_strip_vertices, lower_strip_vertices : (68, 3) float
        The strips of the base mesh (its vertices 15060-15127 and 14992-15059), any unit, +X the subject's
        left, +Y up, +Z out of the face, mirror symmetric about x = 0 (only their left sides are read).

    Returns
    -------
    dict
        For each jaw: ``vertices_upper`` (344, 3), ``quads_upper`` (300, 4), ``uv_upper`` (344, 2) in [0, 1],
        and the same with ``_lower``. Vertices run row by row, from the subject's right to the left; the last
        row is the inner gum. The cage is exactly mirror symmetric about x = 0, open towards the jaw bone, and
        counter-clockwise from outside. The uv unrolls the arch: u from right to left, v from the outer gum to
        the inner one.

    Raises
    ------
    ValueError
        If a strip does not have shape (68, 3) or is not finite.
    """
    strips = {"upper": upper_strip_vertices, "lower": lower_strip_vertices}
    out: dict[str, NDArray] = {}
    for jaw, strip in strips.items():
        strip = np.asarray(strip, float)
        if strip.shape != (_STRIP, 3) or not np.isfinite(strip).all():
            raise ValueError(f"{jaw}_strip_vertices: expected finite ({_STRIP}, 3), got {strip.shape}")
        strips[jaw] = strip
    widths = sum(float(r["width"]) for r in _table("tooth_sizes.csv") if r["jaw"] == "upper")
    scale = _ARCH_SHARE * _arch(strips["upper"], "upper").length / widths
    for jaw, strip in strips.items():
        half = _jaw_vertices(strip, jaw, scale)
        right = half[:, :0:-1] * np.array([-1.0, 1.0, 1.0])
        out[f"vertices_{jaw}"] = np.concatenate([right, half], 1).reshape(-1, 3)
        out[f"quads_{jaw}"] = _jaw_quads(jaw)
        out[f"uv_{jaw}"] = _jaw_uv(half)
    return out


def teeth_shade() -> dict[str, Array]:
    """Where a jaw's cage, after one Catmull-Clark step, is gum, contact or crown; the same for both jaws.

    Returns
    -------
    dict
        (m,) arrays in the order of the subdivided vertices (the cage's own, then its edges sorted by ``(i,
        j)``, then its quads): ``gum`` 1 on the gum and 0 on the crowns, ``contact`` 1 between two teeth,
        ``tooth`` 0 for the central incisors to 6 for the second molars, halves between two, ``inside`` 0
        outside the arch to 1 inside it.
    """
    quads = _jaw_quads("lower")
    row, column = np.divmod(np.arange(_ROWS * (2 * _COLUMNS - 1)), 2 * _COLUMNS - 1)
    side = np.abs(column - (_COLUMNS - 1))
    coarse = np.column_stack([
        np.array([1.0, 1.0, 0.1, 0.0, 0.0, 0.0, 0.25, 1.0])[row],
        side % 3 == 0,
        np.clip(np.where(side % 3 == 0, side / 3 - 0.5, (side - 1) // 3), 0, _TEETH - 1),
        np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0])[row],
    ])  # fmt: skip
    sides = np.sort(np.stack([quads, np.roll(quads, -1, 1)], -1).reshape(-1, 2), 1)
    edges = np.unique(sides, axis=0)
    fine = np.vstack([coarse, coarse[edges].mean(1), coarse[quads].mean(1)])
    return dict(zip(("gum", "contact", "tooth", "inside"), fine.T, strict=True))
