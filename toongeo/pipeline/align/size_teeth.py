"""Upper teeth as large as they are drawn.

Constants: see ``benchmarks/mouths.py``.
"""

import dataclasses

import numpy as np

from toongeo.model.anatomy.parts import TEETH
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.parse.drawn_mouth import DrawnMouth

__all__ = ["size_teeth"]

_COLUMNS = 32  # in which the opening is looked at
_FEWEST = 6  # columns with teeth; with fewer there is no row of them
_SHORTEST = 3  # pixels of a column that tell anything
_FEW_LOW = 0.1  # of the lower third of a column: with less of teeth, lower ones are not drawn there
_BACK = 0.5  # of its height: by so much at most a row that is not drawn goes back behind its lip
_HANGS = 0.3  # of a column's height: teeth that begin lower are not the upper ones
_BREAK = (1.5, 0.06)  # px, and of a column's height: a longer gap below teeth is their lower edge
_HIGHER, _WIDER = (0.5, 2.5), (1.0, 1.6)  # by how much the teeth may be made higher and wider
_GUM = 0.02  # of the mouth's width: by so much the gum begins above the lip's edge, at least


def size_teeth(face: AlignedFace, mouth: DrawnMouth | None) -> AlignedFace:
    """Stretch the upper teeth to the bright band beneath the upper lip.

    The gum stays where it is, or moves up behind the lip; the lower edge of the front teeth comes to where the band
    ends in the picture, and the row becomes as wide as the band. A row that an open mouth does not show goes back
    behind its lip.

    Parameters
    ----------
    face : AlignedFace
    mouth : DrawnMouth or None

    Returns
    -------
    AlignedFace
        The same object, if the mouth is closed.
    """
    if mouth is None or not face.model.has(*TEETH):
        return face
    corners = face.project(face.vertices[face.landmark_vertices[[48, 54]]])
    along = corners[1] - corners[0]
    along /= np.linalg.norm(along)
    down = np.array([-along[1], along[0]])
    columns = _columns(mouth, along, down)
    if not len(columns):
        return face
    V = face.vertices.copy()
    upper, lower = (np.flatnonzero(face.region(part)) for part in TEETH)
    band = columns[np.isfinite(columns[:, 3])]
    if len(band) >= _FEWEST:
        V[upper] = _stretched(face, V[upper], band, mouth.width, along, down)
    else:
        V[upper, 1] += _hidden(face, V[upper], np.median(columns[:, 1]), along, down)
    if (columns[:, 4] < _FEW_LOW).mean() > 0.5:
        V[lower, 1] -= _hidden(face, V[lower], np.median(columns[:, 2]), along, -down)
    return dataclasses.replace(face, vertices=V)


def _stretched(
    face: AlignedFace, X: np.ndarray, band: np.ndarray, width: float, along: np.ndarray, down: np.ndarray
) -> np.ndarray:
    """Upper teeth (k, 3) as high and wide as the band."""
    u, gum, tip = _row(face, X, along, down)
    middle = np.abs(band[:, 0] - np.median(band[:, 0])) < 0.3 * np.ptp(band[:, 0])
    lip, edge = np.median(band[middle, 1]), np.percentile(band[middle, 3], 60)
    top = min(gum, lip - _GUM * width)
    higher = np.clip((edge - top) / max(tip - gum, 1e-6), *_HIGHER)
    wider = np.clip(np.ptp(band[:, 0]) / max(np.ptp(u), 1e-6), *_WIDER)
    middle_mm, top_mm = X[:, 0].mean(), np.percentile(X[:, 1], 95)
    sized = X.copy()
    sized[:, 0] = middle_mm + wider * (X[:, 0] - middle_mm)
    sized[:, 1] = top_mm + higher * (X[:, 1] - top_mm) + (gum - top) / _px_a_mm(face, X)
    return sized


def _hidden(face: AlignedFace, X: np.ndarray, lip: float, along: np.ndarray, down: np.ndarray) -> float:
    """By how many mm a row of teeth (k, 3) has to go back towards its gum, so that it ends at the edge of the lip."""
    _, gum, tip = _row(face, X, along, down)
    edge = lip if down[1] > 0 else -lip
    return float(np.clip(tip - edge, 0, _BACK * (tip - gum)) / _px_a_mm(face, X))


def _row(face: AlignedFace, X: np.ndarray, along: np.ndarray, down: np.ndarray) -> tuple[np.ndarray, float, float]:
    """Places of a row of teeth along the mouth, and where its front begins and ends, px."""
    px = face.project(X)
    u, v = px @ along, px @ down
    front = np.abs(u - np.median(u)) < 0.25 * np.ptp(u)
    gum, tip = np.percentile(v[front], [5, 97])
    return u, float(gum), float(tip)


def _px_a_mm(face: AlignedFace, X: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(face.project(X.mean(0) + np.array([[0, 0, 0], [0, 1.0, 0]])), axis=0)))


def _columns(mouth: DrawnMouth, along: np.ndarray, down: np.ndarray) -> np.ndarray:
    """Columns (k, 5) of the opening: place along the mouth, upper and lower edge, lower edge of the upper teeth (NaN
    where there are none), px, and which share of the lower third is teeth."""
    rows, columns = np.nonzero(mouth.inside)
    points = np.column_stack([columns, rows])
    u, v, teeth = points @ along, points @ down, mouth.teeth[rows, columns]
    edges = np.linspace(u.min(), u.max() + 1e-6, _COLUMNS + 1)
    column = np.digitize(u, edges) - 1
    found = []
    for k in range(_COLUMNS):
        here, bright = v[column == k], np.sort(v[(column == k) & teeth])
        if len(here) < _SHORTEST:
            continue
        top, bottom, height = here.min(), here.max(), np.ptp(here)
        low = teeth[(column == k) & (v > bottom - height / 3)].mean()
        end = np.nan
        if len(bright) >= _SHORTEST and bright[0] - top <= _HANGS * height:
            breaks = np.flatnonzero(np.diff(bright) > max(_BREAK[0], _BREAK[1] * height))
            end = bright[breaks[0]] if len(breaks) else bright[-1]
        found.append(((edges[k] + edges[k + 1]) / 2, top, bottom, end, low))
    return np.array(found).reshape(-1, 5)
