"""The lids: rings of vertices round the eye, and a blink that closes the eyes of all faces."""

from __future__ import annotations

import numpy as np
from cage import Cage, QuadWalk
from contacts import near, opening, skin_walk
from source import Floats, Ints
from thin_plate import Spread, filled

_MARGIN = (
    4854,
    4853,
)  # base-mesh ids: first edge of the loop along the front edge of the margins of the right lids
_LID_KEEP = (0.7, 0.5, 0.7)  # share of the relative motion of the lids that stays
_LID_OVERLAP = 1.2  # mm
_LID_CLEARANCE = 1.2  # mm


def lid_rings(cage: Cage, side: str) -> Ints:
    """Rings of the lids (12, 28) of cage ids, columns aligned: row 0 is the seam with the socket, inside the
    eyeball, row 3 the lid margin, the rows after it lie on the outer skin, ever farther from the eye."""
    walk = skin_walk(cage)
    front = walk.loop(*_MARGIN)
    seam = set(cage.source[np.intersect1d(cage.vertices_of("socket_right"), cage.vertices_of("skin"))].tolist())
    # Inwards lies the side from which the seam is reached in four steps.
    choice = 0 if set(_columns(walk, front, 0, 4)[-1]) == seam else 1
    inwards, outwards = _columns(walk, front, choice, 4), _columns(walk, front, 1 - choice, 7)
    rings = cage.local(np.array([*inwards[::-1], front, *outwards]))
    return rings if side == "right" else cage.mirror[rings]


def _columns(walk: QuadWalk, ring: list[int], choice: int, steps: int) -> list[list[int]]:
    """The next rings on one side of a ring of valence-four vertices."""
    rows = [ring, _side(walk, ring, choice)]
    while len(rows) <= steps:
        before, here = rows[-2:]
        rows.append([next(iter(walk.neighbours[v] - set(here) - {before[k]})) for k, v in enumerate(here)])
    return rows[1:]


def _side(walk: QuadWalk, ring: list[int], choice: int) -> list[int]:
    """One neighbour off the ring for each of its vertices, all on the same side."""
    first = [sorted(walk.neighbours[v] - set(ring)) for v in ring]
    row = [first[0][choice]]
    for pair in first[1:]:
        row.append(pair[0] if pair[0] in walk.neighbours[row[-1]] else pair[1])
    return row


class Lids:
    """The lids of one eye of the mean face: rings of vertices round the opening."""

    def __init__(self, cage: Cage, mean: Floats, side: str) -> None:
        self.cage = cage
        self.rings = lid_rings(cage, side)
        self.line = opening(self.rings[3], mean)
        self.eye = mean[cage.vertices_of(f"eye_{side}")].mean(0)
        domain = near(cage, mean, self.line.vertices, 20.0, ("skin", f"socket_{side}"))
        domain = domain[mean[domain, 0] * np.sign(self.eye[0]) > 2]
        self._spread_margin = Spread(cage, self.line.vertices, domain)
        self._spread_edges = Spread(cage, self.rings[3:5].ravel(), domain)

    def coupled(self, modes: Floats) -> Floats:
        """Identity modes whose eyes differ less in how far they are open, so that one blink closes them
        all."""
        t = np.linspace(0, 1, 81)
        keep = np.minimum(1, np.minimum(t, 1 - t) / 0.2)[:, None] * _LID_KEEP
        out = []
        for mode in modes:
            change = (keep - 1) * self.line.gap(mode, t)
            moved = self.line.sides(change / 2, t)
            out.append(mode + self._spread_margin(np.array([moved[v] for v in self.line.vertices.tolist()])))
        return np.array(out)

    def closed(self, mean: Floats, blink: Floats) -> Floats:
        """The blink (n, 3) with the upper lid just over the front of the lower one, as tiles on a roof: it
        overlaps by `_LID_OVERLAP` so that faces with wider eyes close as well, and lies in front so that
        others do not collide."""
        edges = self.rings[3:5]
        # Columns of the rings run from the outer corner (0) over the upper lid to the inner corner and back
        # below.
        columns = edges.shape[1]
        inner = columns // 2
        change = np.zeros((2, columns, 3))
        # The source drags the outer corner down; it takes the motion of the lower lid beside it.
        for k in range(4):
            change[:, -k] = blink[edges[:, -4]] - blink[edges[:, -k]]
        shut = (mean + blink)[edges] + change
        lower = shut[1, np.r_[0, columns - 1 : inner - 1 : -1]]
        order = np.argsort(lower[:, 0])
        for k in range(1, inner):
            here = shut[0, k]
            below = np.array([np.interp(here[0], lower[order, 0], lower[order, c]) for c in range(3)])
            share = min(1.0, min(k, inner - k) / 3)
            outward = (below - self.eye) / np.linalg.norm(below - self.eye)
            target = below + np.sqrt(share) * _LID_CLEARANCE * outward - share**2 * np.array([0, _LID_OVERLAP, 0])
            change[:, k] = target - here
        shut_smoothly = blink + self._spread_edges(change.reshape(-1, 3))
        # The skin round the outer corner would fold over itself on some faces.
        return filled(self.cage, shut_smoothly, np.unique(self.rings[4:10, np.r_[-4:9]]))
