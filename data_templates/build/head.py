"""The head at both levels: the final control cage L0 (with its teeth) and its Catmull-Clark refinement L1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from cage import PARTS, Cage
from source import Floats, Ints

from toongeo.geometry.catmull_clark import catmull_clark


@dataclass(frozen=True, eq=False)
class Teeth:
    """One row of teeth: `vertices` (a, 3) mm, `quads` (b, 4), `uv` (a, 2) in the unit square."""

    vertices: Floats
    quads: Ints
    uv: Floats


@dataclass(frozen=True, eq=False)
class Head:
    """`mean` (n0, 3) mm; `quads` (q, 4), `quad_part` (q,); `cage_ids` (n0,) the cage vertex, -1 for teeth;
    `teeth` part -> ids; `subdivision` (n1, n0), `quads1` (4 q, 4); `diagonal` (4 q,) split along corners 0-2;
    `triangles` (8 q, 3); `part1` (n1,); `mirror` (n0,) and `mirror1` (n1,)."""

    cage: Cage
    mean: Floats
    quads: Ints
    quad_part: Ints
    cage_ids: Ints
    teeth: dict[str, Ints]
    subdivision: sp.csr_matrix
    quads1: Ints
    diagonal: np.ndarray
    triangles: Ints
    part1: Ints
    mirror: Ints
    mirror1: Ints
    index1: dict[frozenset[int], int]

    def fine(self, coarse: Floats) -> Floats:
        """L1 values of L0 values (n0, ...)."""
        return self.subdivision @ coarse

    def from_cage(self, cage_values: Floats) -> Floats:
        """L0 values of cage values (n, ...); zero at the teeth."""
        out = cage_values[np.maximum(self.cage_ids, 0)].copy()
        out[self.cage_ids < 0] = 0
        return out

    def coarse_of(self, cage_ids: object) -> Ints:
        """L0 ids of cage ids."""
        where = np.full(len(self.cage.rest), -1)
        where[self.cage_ids[self.cage_ids >= 0]] = np.flatnonzero(self.cage_ids >= 0)
        return where[np.asarray(cage_ids)]

    def fine_of(self, source_ids: list[int]) -> int:
        """L1 id of a base-mesh vertex (one id), edge midpoint (two) or quad centre (four)."""
        return self.index1[frozenset(self.coarse_of(self.cage.local(source_ids)).tolist())]

    def fine_loop(self, loop: list[int]) -> Ints:
        """L1 vertices of a closed loop of base-mesh vertices."""
        ids = self.coarse_of(self.cage.local(loop)).tolist()
        pairs = zip(ids, ids[1:] + ids[:1], strict=True)
        return np.array([self.index1[k] for a, b in pairs for k in (frozenset((a,)), frozenset((a, b)))])

    def children(self, quads: Ints) -> Ints:
        """L1 vertices of L0 quads given by their rows."""
        return np.unique(self.quads1[(4 * np.asarray(quads)[:, None] + np.arange(4)).ravel()])


def assemble(cage: Cage, mean: Floats, teeth: dict[str, Teeth]) -> Head:
    """Replace the plain tooth strips of the cage by `teeth` and refine once."""
    keep = np.isin(cage.part, [i for i, p in enumerate(PARTS) if p not in teeth and p in cage.quads])
    keep &= cage.part < len(PARTS)
    cage_ids = np.flatnonzero(keep)
    where = np.full(len(mean), -1)
    where[cage_ids] = np.arange(len(cage_ids))
    vertices, ids = [mean[cage_ids]], [cage_ids]
    mirror = [where[cage.mirror[cage_ids]]]
    quads, parts, tooth_ids, n = [], [], {}, len(cage_ids)
    for part, name in enumerate(PARTS):
        if name in teeth:
            row = teeth[name]
            quads.append(row.quads + n)
            tooth_ids[name] = np.arange(n, n + len(row.vertices))
            vertices.append(row.vertices)
            ids.append(np.full(len(row.vertices), -1))
            mirror.append(_position_mirror(row.vertices) + n)
            n += len(row.vertices)
        else:
            quads.append(where[cage.quads[name]])
        parts.append(np.full(len(quads[-1]), part))
    all_quads, quad_part, all_vertices = np.vstack(quads), np.concatenate(parts), np.vstack(vertices)
    mirror0 = np.concatenate(mirror)
    subdivision, quads1 = catmull_clark(all_quads, n)
    index1 = _subdivision_index(all_quads, quads1)
    mirror1 = np.arange(subdivision.shape[0])
    for key, i in index1.items():
        mirror1[i] = index1[frozenset(mirror0[list(key)].tolist())]
    fine = subdivision @ all_vertices
    diagonal = _shorter_diagonal(fine, quads1, mirror1)
    part1 = np.full(len(fine), len(PARTS))
    for part in range(len(PARTS) - 1, -1, -1):
        part1[quads1[np.repeat(quad_part, 4) == part]] = part
    return Head(
        cage, all_vertices, all_quads, quad_part, np.concatenate(ids), tooth_ids,
        subdivision, quads1, diagonal, triangulated(quads1, diagonal), part1, mirror0, mirror1, index1,
    )  # fmt: skip


def triangulated(quads: Ints, diagonal: np.ndarray) -> Ints:
    """Triangles (2 q, 3), the first of every quad, then the second, split along corners 0-2 where `diagonal`,
    else 1-3."""
    first = np.where(diagonal[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    second = np.where(diagonal[:, None], quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.vstack([first, second])


def _position_mirror(vertices: Floats) -> Ints:
    gap = np.linalg.norm(vertices[:, None] * [-1, 1, 1] - vertices[None], axis=2)
    if gap.min(1).max() > 1e-6:
        raise ValueError(
            f"vertices: expected a mirror-symmetric row of teeth, got a mismatch of {gap.min(1).max():.2g} mm"
        )
    return gap.argmin(1)


def _subdivision_index(quads: Ints, quads1: Ints) -> dict[frozenset[int], int]:
    """L1 vertex of every L0 vertex {a}, edge {a, b} and quad {a, b, c, d}."""
    children = quads1.reshape(-1, 4, 4)
    index = {}
    for quad, child in zip(quads.tolist(), children.tolist(), strict=True):
        index[frozenset(quad)] = child[0][2]
        for c in range(4):
            index[frozenset((quad[c],))] = child[c][0]
            index[frozenset((quad[c], quad[(c + 1) % 4]))] = child[c][1]
    return index


def _shorter_diagonal(vertices: Floats, quads: Ints, mirror: Ints) -> np.ndarray:
    """Whether to split along corners 0-2: the shorter diagonal, and on both sides of the face the same
    one."""

    def length(a: int, b: int) -> Floats:
        return np.linalg.norm(vertices[quads[:, a]] - vertices[quads[:, b]], axis=1)

    choice = length(0, 2) <= length(1, 3)
    other_of = {tuple(sorted(q)): i for i, q in enumerate(quads.tolist())}
    for i, quad in enumerate(mirror[quads].tolist()):
        other = other_of[tuple(sorted(quad))]
        if other > i:
            own = (
                {int(mirror[quads[i, 0]]), int(mirror[quads[i, 2]])}
                if choice[i]
                else {int(mirror[quads[i, 1]]), int(mirror[quads[i, 3]])}
            )
            choice[other] = own == {int(quads[other, 0]), int(quads[other, 2])}
    return choice
