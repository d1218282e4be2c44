"""The control cage: which quads of the base mesh make the head, in named parts."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from source import BaseMesh, Floats, Ints

# The order of the parts in the file. A vertex on the seam of two parts belongs to the first of them.
PARTS = (
    "skin",
    "neck",
    "mouth_cavity",
    "socket_left",
    "socket_right",
    "teeth_upper",
    "teeth_lower",
    "tongue",
)
_HELPERS = {
    "teeth_upper": "helper-upper-teeth",
    "teeth_lower": "helper-lower-teeth",
    "tongue": "helper-tongue",
    "eye_left": "helper-l-eye",
    "eye_right": "helper-r-eye",
}
# First edge of the closed 42-vertex edge loop round the middle of the neck.
_NECK_EDGE = (1496, 8180)
_SOCKET_RINGS = 2


@dataclass(frozen=True, eq=False)
class Cage:
    """Part of the base mesh that the build works on; eyeballs are kept to fit spheres to and dropped when
    packing.

    `source` (n,) ids in the base mesh, ascending; `rest` (n, 3) decimetres; `quads`, `uv_quads`: part -> (q,
    4) local vertex ids and ids into `uv` (t, 2); `part` (n,) index into `PARTS` (len(PARTS) for eyeballs);
    `mirror` (n,).
    """

    source: Ints
    rest: Floats
    quads: dict[str, Ints]
    uv_quads: dict[str, Ints]
    uv: Floats
    part: Ints
    mirror: Ints

    def local(self, source_ids: object) -> Ints:
        """Cage ids of vertices given by their ids in the base mesh."""
        ids = np.asarray(source_ids, dtype=np.int64)
        where = np.searchsorted(self.source, ids)
        if not np.array_equal(self.source[where], ids):
            raise ValueError(f"source_ids: expected vertices of the head, got {ids}")
        return where

    def vertices_of(self, part: str) -> Ints:
        """Sorted ids of all vertices that a quad of `part` uses."""
        return np.unique(self.quads[part])

    def edges(self, *parts: str) -> Ints:
        """Unique edges (e, 2) of the quads of `parts`."""
        q = np.vstack([self.quads[p] for p in parts])
        return np.unique(np.sort(np.stack([q, np.roll(q, -1, 1)], 2).reshape(-1, 2), 1), axis=0)

    def mirrored(self, x: Floats) -> Floats:
        """Displacements or positions (..., n, 3) seen in the mirror plane x = 0."""
        return x[..., self.mirror, :] * np.array([-1.0, 1.0, 1.0])


class QuadWalk:
    """Walks straight on through the edges of a quad mesh, across vertices of valence four."""

    def __init__(self, quads: Ints) -> None:
        self.edge_quads: dict[frozenset[int], list[int]] = defaultdict(list)
        self.neighbours: dict[int, set[int]] = defaultdict(set)
        for i, quad in enumerate(quads.tolist()):
            for a, b in zip(quad, quad[1:] + quad[:1], strict=True):
                self.edge_quads[frozenset((a, b))].append(i)
                self.neighbours[a].add(b)
                self.neighbours[b].add(a)

    def loop(self, first: int, second: int) -> list[int]:
        """Vertices of the closed edge loop that starts with this edge."""
        loop = [first, second]
        while True:
            before, here = loop[-2], loop[-1]
            behind = set(self.edge_quads[frozenset((before, here))])
            ahead = [
                v
                for v in sorted(self.neighbours[here])
                if v != before and not behind & set(self.edge_quads[frozenset((here, v))])
            ]
            if ahead[0] == loop[0]:
                return loop
            loop.append(ahead[0])

    def flood(self, start: int, quads: Ints, fence: list[int]) -> Ints:
        """Quads reached from quad `start` without crossing the closed loop `fence`."""
        closed = {frozenset(e) for e in zip(fence, fence[1:] + fence[:1], strict=True)}
        seen, stack = {start}, [start]
        while stack:
            quad = quads[stack.pop()].tolist()
            for side in zip(quad, quad[1:] + quad[:1], strict=True):
                if frozenset(side) in closed:
                    continue
                new = set(self.edge_quads[frozenset(side)]) - seen
                seen |= new
                stack.extend(sorted(new))
        return np.array(sorted(seen))


def head_cage(base: BaseMesh) -> Cage:
    """Cut the head out of the base mesh and name its parts by their UV islands."""
    quads, uv_quads = _split_parts(base)
    source = np.unique(np.concatenate([q.ravel() for q in quads.values()]))
    local = np.full(len(base.vertices), -1)
    local[source] = np.arange(len(source))
    quads = {name: local[q] for name, q in quads.items()}
    part = np.full(len(source), len(PARTS))
    for i, name in reversed(list(enumerate(PARTS))):
        part[quads[name].ravel()] = i
    return Cage(source, base.vertices[source], quads, uv_quads, base.uv, part, local[base.mirror[source]])


def _split_parts(base: BaseMesh) -> tuple[dict[str, Ints], dict[str, Ints]]:
    body = base.groups == "body"
    q, t = base.quads[body], base.uv_quads[body]
    walk = QuadWalk(q)
    crown = int(base.vertices[q].mean(1)[:, 1].argmax())
    head = walk.flood(crown, q, walk.loop(*_NECK_EDGE))
    links = sp.coo_matrix((np.ones(t.size), (t.ravel(), np.roll(t, -1, 1).ravel())), shape=(len(base.uv),) * 2)
    island = connected_components(links, directed=False)[1][t[head, 0]]
    names, counts = np.unique(island, return_counts=True)
    # By size: face and scalp, inside of the mouth, two sockets, neck.
    skin, cavity, socket_a, socket_b, neck = names[np.argsort(-counts, kind="stable")]
    members = {"skin": skin, "neck": neck, "mouth_cavity": cavity}
    for socket in (socket_a, socket_b):
        left = base.vertices[q[head[island == socket]]][..., 0].mean() > 0
        members["socket_left" if left else "socket_right"] = socket
    quads = {name: q[head[island == k]] for name, k in members.items()}
    uv_quads = {name: t[head[island == k]] for name, k in members.items()}
    for name in ("socket_left", "socket_right"):
        keep = _first_rings(quads[name], np.intersect1d(quads[name], quads["skin"]), _SOCKET_RINGS)
        quads[name], uv_quads[name] = quads[name][keep], uv_quads[name][keep]
    for name, group in _HELPERS.items():
        quads[name], uv_quads[name] = base.quads[base.groups == group], base.uv_quads[base.groups == group]
    return quads, uv_quads


def _first_rings(quads: Ints, seed: Ints, rings: int) -> np.ndarray:
    """Which quads lie within so many rings of the seed vertices."""
    keep = np.zeros(len(quads), dtype=bool)
    reached = np.isin(quads, seed)
    for _ in range(rings):
        keep = reached.any(1)
        reached = np.isin(quads, np.unique(quads[keep]))
    return keep
