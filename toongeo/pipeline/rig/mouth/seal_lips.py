"""Lips that meet and do not cross.

Constants were judged on the seven examples and 15 caricatures (``benchmarks/lips.py``).
"""

import dataclasses
import time

import numpy as np

from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.anatomy.lip_line import LipLine, lip_line
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.rig import Rig

__all__ = ["GAP", "seal_lips"]

GAP = 0.004  # of the mouth's width, left between closed lips: what touches counts as crossing
_UPPER_SHARE = 0.3  # of the way to the lower lip that the upper one goes to meet it
_CORNER = 0.08  # of the length of a lip: where its gap begins to fade out towards the corner; its shifts do so at half
_SPREAD = 0.1  # of the length of a lip: over which a shift fades out along it
_CONTACT = 0.04  # of the mouth's width: only where its edge is so near to the other lip can the red of a lip cross it
_CROSSED = 0.02  # of the mouth's width: by how much points of a drawing may have the lips cross in the neutral face
_MOVES_MM = 0.3  # expressions that move the lips less leave them as they are
_ROUNDS = 2  # shifted lips lie elsewhere along each other; the second round sees to what this changes


def seal_lips(face: AlignedFace, rig: Rig) -> Rig:
    """Make the lips meet in ``mouthClose`` and ``mouthPucker``, and keep them from crossing in the others.

    Deformation transfer keeps rotations and stretches, not contacts. ``mouthClose``, a corrective of ``jawOpen``, is
    given the motion that brings the lines where the lips end together, all along: at 1, with ``jawOpen`` at 1, they
    are 0.4 % of the mouth's width apart, also when the neutral mouth is open. ``mouthPucker`` (of closed lips, by its
    definition in ARKit; the template's leaves them apart) seals them alike, without the jaw. In every other expression
    at 1 no point of a lip comes closer to the other lip, seen from the front, than twice this or than it was in the
    neutral face; where one does both give way, half each. So they do in a neutral face whose lips cross more than those
    of the aligned one, or by more than points that are set by hand do. The face around follows as a thin plate, and
    what lies farther away stays.

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
    line, neutral, deltas = lip_line(face.model), rig.neutral.copy(), rig.deltas.copy()
    up = _up(line, neutral)
    crossed = -_CROSSED * np.linalg.norm(neutral[line.upper[-1]] - neutral[line.upper[0]])
    drawn = [np.maximum(heights, crossed) for heights in _heights(line, face.vertices, up)]
    neutral[line.follows] += line.spread @ _parting(line, neutral, up, drawn)
    neutral_aligned = _heights(line, neutral, up)
    sealed = [rig.names.index(name) for name in ("mouthClose", "mouthPucker") if name in rig.names]
    moves = np.abs(deltas[:, line.vertices]).max((1, 2)) > _MOVES_MM
    moves[sealed] = False
    for k in np.flatnonzero(moves):
        deltas[k, line.follows] += line.spread @ _parting(line, neutral + deltas[k], up, neutral_aligned)
    report = rig.report
    for seal in sealed:
        pucker, jaw_too = rig.names[seal] == "mouthPucker", "jawOpen" in rig.names
        opened = neutral + (deltas[rig.names.index("jawOpen")] if jaw_too and not pucker else 0.0)
        deltas[seal, line.follows] += line.spread @ _sealing(line, opened + deltas[seal], up)
        if jaw_too and not pucker:
            closure = 100 * (1 - _gap(line, opened + deltas[seal]) / _gap(line, opened))
            report = dataclasses.replace(report, lips_closure=closure)
    return dataclasses.replace(rig, report=report).changed(started, neutral=neutral, deltas=deltas)


def _sealing(line: LipLine, V: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Shifts (u + l - 2, 3) of the line that bring the lips together, paired by their lengths from corner to corner."""
    upper, lower = V[line.upper], V[line.lower]
    at_upper, at_lower = arc_shares(upper), arc_shares(lower)
    half = GAP / 2 * np.linalg.norm(upper[-1] - upper[0]) * up
    opposite = interpolated(at_lower, at_upper, upper)
    meeting = opposite + _UPPER_SHARE * (lower - opposite)
    # The upper lip has more vertices: it is laid on the edges between those of the lower one.
    to_upper = interpolated(at_upper, at_lower, meeting) + _taper(at_upper, _CORNER)[:, None] * half
    to_lower = meeting - _taper(at_lower, _CORNER)[:, None] * half
    return np.vstack([to_upper - upper, (to_lower - lower)[1:-1]])


def _parting(line: LipLine, V: np.ndarray, up: np.ndarray, neutral_aligned: list[np.ndarray]) -> np.ndarray:
    """Shifts (u + l - 2, 3) of the line, up and down, that keep each lip on its side of the other."""
    shift = np.zeros((len(line.vertices), 3))
    at_upper, at_lower = arc_shares(V[line.upper]), arc_shares(V[line.lower])
    place = np.r_[at_upper, at_upper[line.upper_column], at_lower, at_lower[line.lower_column]]
    least = 2 * GAP * np.linalg.norm(V[line.upper[-1]] - V[line.upper[0]]) * _taper(place, _CORNER)
    rest = np.concatenate(neutral_aligned)
    least = np.minimum(np.where(np.isinf(rest), 0.0, rest), least)
    for _ in range(_ROUNDS):
        moved = V.copy()
        moved[line.follows] += line.spread @ shift
        lack = least - np.concatenate(_heights(line, moved, up))
        lacks = lack > 0
        if not lacks.any():
            break
        rise, fall = (
            _taper(at, _CORNER / 2) * _spread(at, place[lacks], lack[lacks]) / 2 for at in (at_upper, at_lower)
        )
        shift += np.r_[rise, -fall[1:-1]][:, None] * up
    return shift


def _heights(line: LipLine, V: np.ndarray, up: np.ndarray) -> list[np.ndarray]:
    """How far upper and lower lip (path, then red) are on their side of the other's path, at the same place along it.

    Infinitely far: what lies beside the mouth, and red of a lip that is before the other lip or away from it.
    """
    axis = V[line.upper[-1]] - V[line.upper[0]]
    sides = []
    for path, red, column, other, sign in (
        (line.upper, line.upper_red, line.upper_column, line.lower, 1.0),
        (line.lower, line.lower_red, line.lower_column, line.upper, -1.0),
    ):
        order = other[np.argsort(V[other] @ axis, kind="stable")]
        points = np.r_[path, red]
        place, known = V[points] @ axis, V[order] @ axis
        heights = sign * (V[points] @ up - np.interp(place, known, V[order] @ up))
        heights[(place < known[0]) | (place > known[-1])] = np.inf
        before = V[red, 2] > np.interp(place[len(path) :], known, V[order, 2])
        away = heights[column] > _CONTACT * np.linalg.norm(axis)
        heights[len(path) :][before | away] = np.inf
        sides.append(heights)
    return sides


def _gap(line: LipLine, V: np.ndarray) -> float:
    """Mean distance of upper and lower path, paired by their lengths."""
    upper, lower = V[line.upper], V[line.lower]
    return float(np.linalg.norm(interpolated(arc_shares(lower), arc_shares(upper), upper) - lower, axis=1).mean())


def _spread(at: np.ndarray, place: np.ndarray, lack: np.ndarray) -> np.ndarray:
    """The least (k,) at each position that is enough at every place and fades out around it."""
    return np.asarray((lack * np.exp(-(((at[:, None] - place) / _SPREAD) ** 2))).max(1))


def _up(line: LipLine, V: np.ndarray) -> np.ndarray:
    """Unit vector (3,) across the mouth, as upright as can be."""
    axis = V[line.upper[-1]] - V[line.upper[0]]
    up = np.array([0.0, 1.0, 0.0]) - axis[1] / (axis @ axis) * axis
    return np.asarray(up / np.linalg.norm(up))


def _taper(at: np.ndarray, corner: float) -> np.ndarray:
    """From 0 at the corners to 1."""
    return np.minimum(1.0, np.minimum(at, 1 - at) / corner)
