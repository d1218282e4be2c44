"""Expressions that do not fold the skin around the mouth.

Constants were chosen on bad_guy, manga_girl, 11, 31 and 44 (``benchmarks/crossings.py``).
"""

import time
from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from toongeo.model import MorphableModel
from toongeo.model.anatomy.lip_line import lip_line
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.mouth.lower_face import lower_face
from toongeo.pipeline.rig.mouth.open_as_drawn import OPENING
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.rig.skin.affine_around import affine_around
from toongeo.pipeline.rig.skin.crossing_triangles import Sheet, around, crossing_triangles
from toongeo.pipeline.rig.skin.neighbour_means import neighbour_means

__all__ = ["unfold_mouth"]

_NAMES = ("cheek", "jaw", "mouth", "nose")
_LIPS_MM = 6.5  # on the template, from the line where the lips meet: there skin lies upon skin and crosses unbent
_MOVES_MM = 0.3  # lips that move less stay as they are
# Skin that comes to cross is sheared or turned: ends of its edges part by so much of their length, or those of edges
# so near.
_BENT, _REACH = 0.5, 3
_ALLOWED = 3  # triangles that may intersect others
_SMOOTHED = ((3, 3), (5, 8))  # edges around crossings, and how often motions are made alike there
_PRESSED = ((2, 3), (4, 6))  # edges around crossings where motions are made affine, and where that fades out
_TIMES = 2  # that this is done: a fading motion may cross what is around it
_SURROUNDINGS = 7  # edges around crossings within which new ones are looked for
_WEAKENED = (0.7,)  # of an expression that still crosses: less of it would no longer be seen


def unfold_mouth(face: AlignedFace, rig: Rig) -> Rig:
    """Make expressions of the mouth gentler where they push skin through skin.

    Lips that are drawn thin, or shut, have less room between them than the template's, and corners have the least.
    Where triangles come to intersect others that did not in the neutral face, the motions of neighbours are made
    alike, or affine (:func:`~toongeo.pipeline.rig.skin.affine_around.affine_around`), and if that does not help, the
    expression is weakened, to 0.7 at most; of all that is tried the gentlest change that helps is taken, or the one
    that leaves the fewest. What opens the mouth of the picture is not weakened.
    ``mouthClose`` is changed by what ``jawOpen`` lost, so that both together still seal the lips.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        With sealed lips (:func:`~toongeo.pipeline.rig.mouth.seal_lips.seal_lips`).

    Returns
    -------
    Rig
        A new one; only shapes that folded the skin differ, and ``mouthClose``.
    """
    started = time.perf_counter()
    model, neutral, deltas = face.model, rig.neutral, rig.deltas.copy()
    patch, index = lower_face(model), {name: k for k, name in enumerate(rig.names)}
    looked_at = [k for name, k in index.items() if name.startswith(_NAMES) and name != "mouthClose"]
    suspects = {k: _suspects(model, neutral, deltas[k]) for k in looked_at}
    sheets = [Sheet(neutral + deltas[k], triangles) for k, triangles in suspects.items()]
    for k, hit in zip(suspects, crossing_triangles(patch, sheets), strict=True):
        if len(hit) > _ALLOWED:
            gains = None if rig.names[k] == "mouthPucker" else () if rig.names[k] in OPENING else _WEAKENED
            deltas[k] = _gentler(model, neutral, deltas[k].astype(float), hit, gains)
    if {"jawOpen", "mouthClose"} <= index.keys():
        jaw = index["jawOpen"]
        deltas[index["mouthClose"]] += rig.deltas[jaw] - deltas[jaw]
    return rig.changed(started, deltas=deltas)


def _gentler(
    model: MorphableModel, neutral: np.ndarray, way: np.ndarray, hit: np.ndarray, gains: tuple[float, ...] | None
) -> np.ndarray:
    """A motion (n, 3) like ``way`` that leads fewer triangles of the lower face through others than ``hit`` (c,).

    Without ``gains`` it is made affine only, which keeps sealed lips together.
    """
    patch = lower_face(model)
    known = around(model, patch.vertices[patch.faces[hit]], _SURROUNDINGS)[patch.vertices] > 0
    looked_at = np.flatnonzero(known[patch.faces].any(1))
    resting = crossing_triangles(patch, [Sheet(neutral, looked_at)])[0]
    best, smoothed = way, gains is not None
    for _ in range(_TIMES):
        at, least = patch.vertices[patch.faces[hit]], len(hit)
        for tries in _gentler_ways(model, neutral, best, at, smoothed, gains):
            crossing = crossing_triangles(patch, [Sheet(neutral + tried, looked_at) for tried in tries])
            for tried, found in zip(tries, crossing, strict=True):
                left = np.setdiff1d(found, resting)
                if len(left) < len(hit):
                    hit, best = left, tried
                if len(hit) <= _ALLOWED:
                    return best
        if len(hit) == least:
            break
        smoothed, gains = False, None
    return best


def _gentler_ways(
    model: MorphableModel,
    neutral: np.ndarray,
    way: np.ndarray,
    at: np.ndarray,
    smoothed: bool,
    gains: tuple[float, ...] | None,
) -> Iterator[list[np.ndarray]]:
    """Motions (n, 3) to try, the gentlest change first: alike around vertices, affine there, weaker."""
    smooth = [_alike(model, way, at, *how) for how in _SMOOTHED] if smoothed else []
    yield smooth
    pressed = [_pressed(model, neutral, start, at, *how) for how in _PRESSED for start in (way, *smooth[-1:])]
    yield pressed
    yield [gain * tried for gain in gains or () for tried in (way, *smooth, *pressed)]


def _alike(model: MorphableModel, way: np.ndarray, at: np.ndarray, width: int, passes: int) -> np.ndarray:
    """Motions (n, 3) made like those of their neighbours around vertices, but where there are none."""
    weight = around(model, at, width) * way.any(1)
    moved = np.flatnonzero(weight)
    means, way = neighbour_means(model)[moved], way.copy()
    for _ in range(passes):
        way[moved] += weight[moved, None] * (means @ way - way[moved])
    return way


def _pressed(
    model: MorphableModel, neutral: np.ndarray, way: np.ndarray, at: np.ndarray, core: int, fade: int
) -> np.ndarray:
    """Motions (n, 3) that are affine around vertices, but where there are none."""
    moving = np.asarray(way.any(axis=1))[:, None]
    return (affine_around(model, neutral, neutral + way, at, core, fade) - neutral) * moving


def _suspects(model: MorphableModel, neutral: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Triangles (t,) of the lower face that may come to cross others: what bends, around it, and the lips."""
    patch, edges = lower_face(model), _edges(model)
    length, moved = neutral[patch.vertices], way[patch.vertices]
    length = np.linalg.norm(length[edges[:, 0]] - length[edges[:, 1]], axis=1)
    parted = np.linalg.norm(moved[edges[:, 0]] - moved[edges[:, 1]], axis=1)
    bent = around(model, patch.vertices[edges[parted > _BENT * length]], _REACH)[patch.vertices] > 0
    looked_at = bent | (_lips(model) & (np.abs(moved).max(1) > _MOVES_MM))
    return np.flatnonzero(looked_at[patch.faces].all(1))


@lru_cache(maxsize=4)
def _edges(model: MorphableModel) -> np.ndarray:
    """Edges (e, 2) of the lower face, by the places of its vertices."""
    edges = lower_face(model).faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.unique(np.sort(edges, axis=1), axis=0)


@lru_cache(maxsize=4)
def _lips(model: MorphableModel) -> np.ndarray:
    """Which vertices of the lower face are near the line where the lips meet."""
    line = model.mean[lip_line(model).vertices]
    return np.asarray(cKDTree(line).query(model.mean[lower_face(model).vertices])[0] < _LIPS_MM)
