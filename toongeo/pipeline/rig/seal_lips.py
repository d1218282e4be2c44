"""Lips that meet and do not cross."""

import dataclasses
import time

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.lip_line import LipLine, lip_line
from toongeo.pipeline.rig.rig import Rig

GAP = 0.003  # of the mouth's width, left between closed lips: what touches counts as crossing
UPPER_SHARE = 0.3  # of the way to the lower lip that the upper one goes to meet it
CORNER = 0.1  # of the length of a lip: where its gap begins to fade out towards the corner; its shifts do at half of this
SPREAD = 0.08  # of the length of a lip: over which a shift fades out along it
MOVES_MM = 0.3  # expressions that move the lips less leave them as they are
ROUNDS = 2  # shifted lips lie elsewhere along each other; the second round sees to what this changes


def seal_lips(face: AlignedFace, rig: Rig) -> Rig:
    """Make the lips meet in ``mouthClose``, and keep them from crossing in the other expressions.

    Deformation transfer keeps rotations and stretches, not contacts. ``mouthClose``, a corrective of ``jawOpen``, is
    given the motion that brings the lines where the lips end together, all along: at 1, with ``jawOpen`` at 1, they
    are 0.3 % of the mouth's width apart, also when the neutral mouth is open. In every other expression at 1 no point
    of a lip comes closer to the other lip, seen from the front, than this or than it was in the neutral face; where one
    does both give way, half each. The face around follows as a thin plate, and what lies farther away stays.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig

    Returns
    -------
    Rig
        A new one, whose report has ``lips_closure`` in percent: how much less the lips are apart, on the average along
        them, with ``mouthClose`` than in ``jawOpen`` alone.
    """
    started = time.perf_counter()
    line, deltas = lip_line(face.model), rig.deltas.copy()
    up = _up(line, rig.neutral)
    at_rest = _heights(line, rig.neutral, up)
    close, jaw = (rig.names.index(name) for name in ("mouthClose", "jawOpen"))
    moves = np.abs(deltas[:, line.vertices]).max((1, 2)) > MOVES_MM
    moves[close] = False
    for k in np.flatnonzero(moves):
        shift = _parting(line, rig.neutral + deltas[k], up, at_rest)
        if shift.any():
            deltas[k, line.follows] += line.spread @ shift
    opened = rig.neutral + deltas[jaw]
    before = opened + deltas[close]
    deltas[close, line.follows] += line.spread @ _sealing(line, before, up)
    gaps = [_gap(line, V) for V in (opened, opened + deltas[close])]
    report = rig.report | {
        "lips_closure": 100 * (1 - gaps[1] / gaps[0]),
        "seconds": rig.report["seconds"] + time.perf_counter() - started,
    }
    return dataclasses.replace(rig, deltas=deltas, report=report)


def _sealing(line: LipLine, V: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Shifts (u + l - 2, 3) of the line that bring the lips together, paired by their lengths from corner to corner."""
    upper, lower = V[line.upper], V[line.lower]
    at_upper, at_lower = _along(upper), _along(lower)
    half = GAP / 2 * np.linalg.norm(upper[-1] - upper[0]) * up
    opposite = _interpolated(at_lower, at_upper, upper)
    meeting = opposite + UPPER_SHARE * (lower - opposite)
    # The upper lip has more vertices: it is laid on the edges between those of the lower one.
    to_upper = _interpolated(at_upper, at_lower, meeting) + _taper(at_upper)[:, None] * half
    to_lower = meeting - _taper(at_lower)[:, None] * half
    return np.vstack([to_upper - upper, (to_lower - lower)[1:-1]])


def _parting(line: LipLine, V: np.ndarray, up: np.ndarray, at_rest: list[np.ndarray]) -> np.ndarray:
    """Shifts (u + l - 2, 3) of the line, up and down, that keep each lip on its side of the other."""
    shift = np.zeros((len(line.vertices), 3))
    V = V.copy()
    at_upper, at_lower = _along(V[line.upper]), _along(V[line.lower])
    width = np.linalg.norm(V[line.upper[-1]] - V[line.upper[0]])
    at = np.r_[at_upper, at_upper[line.upper_column]], np.r_[at_lower, at_lower[line.lower_column]]
    for _ in range(ROUNDS):
        heights = _heights(line, V, up)
        lacks = [
            np.maximum(np.minimum(np.where(np.isinf(rest), 0, rest), 2 * GAP * width * _taper(place)) - height, 0)
            for height, rest, place in zip(heights, at_rest, at, strict=True)
        ]
        place, lack = np.concatenate(at), np.concatenate(lacks)
        place, lack = place[lack > 0], lack[lack > 0]
        if not len(lack):
            break
        rise, fall = (_taper(where, CORNER / 2) * _spread(where, place, lack) / 2 for where in (at_upper, at_lower))
        step = np.r_[rise, -fall[1:-1]][:, None] * up
        shift += step
        V[line.follows] += line.spread @ step
    return shift


def _heights(line: LipLine, V: np.ndarray, up: np.ndarray) -> list[np.ndarray]:
    """How far upper and lower lip (path, then red) are on their side of the other's path, at the same place along it.

    What lies beside the mouth is infinitely far.
    """
    axis = V[line.upper[-1]] - V[line.upper[0]]
    heights = []
    for points, other, sign in (
        (np.r_[line.upper, line.upper_red], line.lower, 1.0),
        (np.r_[line.lower, line.lower_red], line.upper, -1.0),
    ):
        order = other[np.argsort(V[other] @ axis, kind="stable")]
        against = np.interp(V[points] @ axis, V[order] @ axis, V[order] @ up, left=-sign * np.inf, right=-sign * np.inf)
        h = sign * (V[points] @ up - against)
        z = V[points][:, 2] - np.interp(V[points] @ axis, V[order] @ axis, V[order][:, 2])
        p, col = (line.upper, line.upper_column) if sign > 0 else (line.lower, line.lower_column)
        n = len(p)
        h[n:][(z[n:] > 0) | (h[:n][col] > 0.02 * np.linalg.norm(axis))] = np.inf
        heights.append(h)
    return heights


def _gap(line: LipLine, V: np.ndarray) -> float:
    """Mean distance of upper and lower path, paired by their lengths."""
    upper, lower = V[line.upper], V[line.lower]
    opposite = _interpolated(_along(lower), _along(upper), upper)
    return float(np.linalg.norm(opposite - lower, axis=1).mean())


def _spread(at: np.ndarray, place: np.ndarray, lack: np.ndarray) -> np.ndarray:
    """The least (k,) at each position that is enough at every place and fades out around it."""
    return np.asarray((lack * np.exp(-(((at[:, None] - place) / SPREAD) ** 2))).max(1))


def _up(line: LipLine, V: np.ndarray) -> np.ndarray:
    """Unit vector (3,) across the mouth, as upright as can be."""
    axis = V[line.upper[-1]] - V[line.upper[0]]
    up = np.array([0.0, 1.0, 0.0]) - axis[1] / (axis @ axis) * axis
    return np.asarray(up / np.linalg.norm(up))


def _taper(at: np.ndarray, corner: float = CORNER) -> np.ndarray:
    """From 0 at the corners to 1."""
    return np.minimum(1.0, np.minimum(at, 1 - at) / corner)


def _along(path: np.ndarray) -> np.ndarray:
    """Length along a path of points (k, 3) up to each, as a share of the whole."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
    return np.asarray(length / length[-1])


def _interpolated(at: np.ndarray, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    return np.column_stack([np.interp(at, known, values[:, axis]) for axis in range(3)])
