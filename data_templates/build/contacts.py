"""Where skin meets skin: openings with two sides, and the lips.

Modes and expressions are linear, so nothing stops one lip from passing through the other. Here the relative
motion of the two sides of an opening is limited where the modes are made, and the change is spread smoothly
over the skin around.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from cage import Cage, QuadWalk
from scipy.spatial import cKDTree
from source import Floats, Ints
from thin_plate import Spread

# First edges of closed edge loops, in base-mesh ids.
LIP_RIM = (493, 487)  # where the lips meet
LIP_BORDER = (492, 486)  # border of the red of the lips
_LIP_GAP = 0.5  # mm between the lips of the mean face
_LIP_SIGMAS = 3.5
_LIP_KEEP = (0.6, 0.3, 0.6)  # share of the relative motion of the lips that stays; the vertical one at most
_LIP_GAP_LEFT = 0.35  # mm of it that an expression must leave


@dataclass(frozen=True, eq=False)
class Opening:
    """The two sides of an opening, `upper` and `lower` cage ids from one corner to the other, corners in
    both; and the parameter in [0, 1] of each of their vertices along the line between the corners."""

    upper: Ints
    lower: Ints
    t_upper: Floats
    t_lower: Floats

    @property
    def vertices(self) -> Ints:
        """All vertices of the loop, once."""
        return np.unique(np.r_[self.upper, self.lower])

    def gap(self, x: Floats, t: Floats) -> Floats:
        """Upper minus lower side (len(t), 3) of positions or displacements (n, 3) at parameters t."""
        return along(self.t_upper, x[self.upper], t) - along(self.t_lower, x[self.lower], t)

    def sides(self, upper: Floats, t: Floats) -> dict[int, Floats]:
        """Vertex -> value for a change by `upper` (len(t), 3) of the upper side and by its opposite of the
        lower."""
        out = dict(zip(self.lower.tolist(), -along(t, upper, self.t_lower), strict=True))
        corners = out[int(self.lower[0])] * 0.0
        out |= dict(zip(self.upper.tolist(), along(t, upper, self.t_upper), strict=True))
        out[int(self.upper[0])] = out[int(self.upper[-1])] = corners
        return out


def opening(loop: Ints, mean: Floats) -> Opening:
    """Split a closed loop of cage ids at its vertices farthest to the right and to the left."""
    x = mean[loop, 0]
    loop = np.roll(loop, -int(x.argmin()))
    far = int(mean[loop, 0].argmax())
    one, other = loop[: far + 1], np.r_[loop[0], loop[far:][::-1]]
    upper, lower = (one, other) if mean[one, 1].mean() > mean[other, 1].mean() else (other, one)
    low, high = mean[loop[0], 0], mean[loop[far], 0]
    t = [np.maximum.accumulate((mean[side, 0] - low) / (high - low)) for side in (upper, lower)]
    return Opening(upper, lower, *t)


def skin_walk(cage: Cage) -> QuadWalk:
    """The skin in base-mesh ids."""
    return QuadWalk(cage.source[cage.quads["skin"]])


def skin_quads_within(cage: Cage, loop: list[int], beyond: Ints) -> Ints:
    """Rows of the skin quads inside a closed loop of base-mesh ids, on the side where the cage vertices
    `beyond` lie."""
    quads = cage.source[cage.quads["skin"]]
    start = int(np.flatnonzero(np.isin(quads, cage.source[beyond]).any(1))[0])
    return skin_walk(cage).flood(start, quads, loop)


def inner_lips(cage: Cage) -> Ints:
    """Skin vertices behind the line where the lips meet."""
    rim = skin_walk(cage).loop(*LIP_RIM)
    rows = skin_quads_within(cage, rim, cage.vertices_of("mouth_cavity"))
    return np.setdiff1d(cage.quads["skin"][rows], cage.local(rim))


def near(cage: Cage, mean: Floats, seed: Ints, reach: float, parts: tuple[str, ...]) -> Ints:
    """Vertices of `parts` within `reach` mm of the seed vertices."""
    ids = np.unique(np.concatenate([cage.vertices_of(p) for p in parts]))
    return ids[cKDTree(mean[seed]).query(mean[ids])[0] < reach]


class Lips:
    """The line where the lips meet in the mean face, and smooth changes of its gap."""

    def __init__(self, cage: Cage, mean: Floats) -> None:
        self.line = opening(cage.local(skin_walk(cage).loop(*LIP_RIM)), mean)
        self.t = np.linspace(0, 1, 81)
        # From 0 at the corners to 1.
        self.taper = np.minimum(1, np.minimum(self.t, 1 - self.t) / 0.12)
        domain = near(cage, mean, self.line.vertices, 22.0, ("skin", "mouth_cavity"))
        self._spread = Spread(cage, self.line.vertices, domain)

    def gap(self, x: Floats) -> Floats:
        """Upper minus lower lip (81, 3) along the line."""
        return self.line.gap(x, self.t)

    def widened(self, x: Floats, change: Floats) -> Floats:
        """`x` (n, 3) with its gap changed by `change` (81, 3), half by either lip."""
        moved = self.line.sides(change / 2, self.t)
        return x + self._spread(np.array([moved[v] for v in self.line.vertices.tolist()]))

    def coupled(self, mean: Floats, modes: Floats) -> tuple[Floats, Floats]:
        """Mean and modes whose lips meet without passing through each other for most coefficients.

        The gap of the mean becomes `_LIP_GAP`; the vertical motion of one lip against the other is damped
        until `_LIP_SIGMAS` standard deviations of it fit into the gap, sideways and depth by `_LIP_KEEP`.
        """
        wanted = _LIP_GAP * self.taper
        deviation = np.sqrt(sum(self.gap(mode) ** 2 for mode in modes))
        keep = np.tile(_LIP_KEEP, (len(self.t), 1)) * np.minimum(1, np.minimum(self.t, 1 - self.t) / 0.2)[:, None]
        keep[:, 1] = np.minimum(keep[:, 1], wanted / (_LIP_SIGMAS * np.maximum(deviation[:, 1], 1e-9)))
        closing = np.zeros((len(self.t), 3))
        closing[:, 1] = wanted - self.gap(mean)[:, 1]
        return self.widened(mean, closing), np.array([self.widened(m, (keep - 1) * self.gap(m)) for m in modes])

    def steadied(self, modes: Floats) -> Floats:
        """Modes of either sign (k, n, 3) that change the vertical gap by less than what the mean has to
        spare."""
        out = []
        for mode in modes:
            gap = self.gap(mode)[:, 1]
            change = np.zeros((len(self.t), 3))
            change[:, 1] = np.clip(gap, -_LIP_GAP_LEFT, _LIP_GAP_LEFT) * self.taper - gap
            out.append(self.widened(mode, change))
        return np.array(out)

    def parted(self, mean: Floats, named: dict[str, Floats]) -> dict[str, Floats]:
        """Named expressions in which the lips of `mean` do not cross.

        At weight 1 some of the gap must remain; a left and a right unit share what may be used up.
        """
        slack = self.gap(mean)[:, 1] - _LIP_GAP_LEFT * self.taper
        left_share = 0.5 + 0.5 * np.sin(np.pi * np.clip((self.t - 0.5) / 0.6, -0.5, 0.5))
        out = {}
        for name, delta in named.items():
            share = left_share if name.endswith("Left") else left_share[::-1] if name.endswith("Right") else 1.0
            base = self.gap(named["jawOpen"])[:, 1] if name == "mouthClose" else 0.0
            change = np.zeros((len(self.t), 3))
            change[:, 1] = np.maximum(0, -share * slack - self.gap(delta)[:, 1] - base)
            out[name] = self.widened(delta, change) if change.any() else delta
        return out


def along(t: Floats, values: Floats, at: Floats) -> Floats:
    """Rows of `values` (k, 3), given at parameters `t` (k,), interpolated at others."""
    return np.stack([np.interp(at, t, values[:, c]) for c in range(3)], axis=1)
