"""A face without the expression of its picture.

Constants were judged on the seven examples (``benchmarks/rig.py``); of closing: ``benchmarks/mouths.py``.
"""

import dataclasses

import numpy as np

from toongeo.geometry import DeformationTransfer, laplacian_align
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lips_apart import lips_apart
from toongeo.model.anatomy.rims import rim_path
from toongeo.model.anatomy.still_vertices import still_vertices
from toongeo.model.expression_features import REMOVED, SIGNS
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.align.keep_teeth_inside import keep_teeth_inside
from toongeo.pipeline.rig.mouth.closed_mouth import NEEDS, closed_mouth
from toongeo.pipeline.rig.mouth.open_as_drawn import OPENING

__all__ = ["neutral_face"]

# Of the mouth's width, mean: where a mouth begins to be closed, and is closed wholly. The template's is 0.02.
_APART = (0.03, 0.05)
_SURE = (0.3, 0.6)  # weights of a sign from which an expression begins to be removed, and is removed wholly
_PARTED = (0.1, 0.2)  # the same for the gap between the lips, in widths of the mouth
_WEIGHT = 1e3  # of the anchors on the lips: they are met to about a hundredth of a millimetre


def neutral_face(face: AlignedFace) -> AlignedFace:
    """The aligned face with its mouth at rest: closed, where the picture has it open.

    The drawn lips are brought together as two curves, and the face below them follows
    (:func:`~toongeo.pipeline.rig.mouth.closed_mouth.closed_mouth`). No expression is taken out: what a fit calls a
    smile is often the face, and drawn lips that shrink with it pile up. Where lips would cross or be strained too much
    they close as far as they go. Shut eyes stay shut: what is behind them was never seen.

    A model that does not tell where the lips end (without ``mouth_cavity``) has the expression of the mouth taken out
    instead, where it clearly has one (it smiles, is open, bares its teeth or purses its lips: the signs in
    ``expression_features.csv``, by their weights). The gradients from the fitted model face with the expression to the
    same without it are carried over to the aligned face, and the lips get the gap that the model's have. All that the
    fit found about the mouth goes at once; a part of a smile would be a grimace.

    Parameters
    ----------
    face : AlignedFace

    Returns
    -------
    AlignedFace
        Its ``fit`` has the rest of the expression. The same object, if there is nothing to close or remove.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> at_rest = tg.neutral_face(face)
    >>> at_rest.vertices.shape
    (19057, 3)
    """
    return _closed(face) if face.model.has(*NEEDS) else _without_expression(face)


def _closed(face: AlignedFace) -> AlignedFace:
    model, V = face.model, face.vertices
    share = _ramp(lips_apart(model, V), _APART)
    if share == 0:
        return face
    expression = face.fit.expression.copy()
    expression[[name in OPENING for name in model.expression_names]] *= 1 - share
    fit = dataclasses.replace(face.fit, expression=expression)
    closed = V + share * (closed_mouth(model, V) - V)
    return dataclasses.replace(face, vertices=keep_teeth_inside(model, closed), fit=fit)


def _without_expression(face: AlignedFace) -> AlignedFace:
    model, expression = face.model, face.fit.expression.copy()
    share = max(_by_signs(model, expression), _by_gap(model, face.vertices))
    mouth = [k for k, name in enumerate(model.expression_names[: model.n_named]) if name in REMOVED]
    if share == 0 or not mouth:
        return face
    expression[mouth] *= 1 - share
    fit = dataclasses.replace(face.fit, expression=expression)
    transfer = DeformationTransfer(
        face.fit.vertices, model.faces, face.vertices, pinned=still_vertices(model), align=True
    )
    V = transfer(fit.vertices)
    if model.has("mouth"):
        V = _lips_as(model, fit.vertices, V, share)
    return dataclasses.replace(face, vertices=keep_teeth_inside(model, V), fit=fit)


def _by_signs(model: MorphableModel, expression: np.ndarray) -> float:
    """How much of the expression is to go, in [0, 1], by its strongest sign; 0 for a model that has none of them."""
    weights = dict(zip(model.expression_names, expression.tolist(), strict=True))
    strongest = max(float(np.mean([weights.get(name, 0.0) for name in names])) for names in SIGNS.values())
    return _ramp(strongest, _SURE)


def _by_gap(model: MorphableModel, V: np.ndarray) -> float:
    """The same by how far the lips are parted: drawings open mouths in ways that no expression of the model has."""
    upper, lower = rim_path(model, "lip_upper_inner"), rim_path(model, "lip_lower_inner")
    gap = np.linalg.norm(V[upper][:, None] - V[lower], axis=2).min(1).max()
    return _ramp(float(gap / np.linalg.norm(V[upper[-1]] - V[upper[0]])), _PARTED)


def _ramp(value: float, limits: tuple[float, float]) -> float:
    return float(np.clip((value - limits[0]) / (limits[1] - limits[0]), 0, 1))


def _lips_as(model: MorphableModel, rest: np.ndarray, V: np.ndarray, share: float) -> np.ndarray:
    """Vertices with the gap between the lips as in ``rest`` (n, 3), in proportion to the mouth, by the share."""
    upper, lower = (rim_path(model, f"lip_{lip}_inner") for lip in ("upper", "lower"))
    width = [np.linalg.norm(X[upper[-1]] - X[upper[0]]) for X in (V, rest)]
    patch = (model.region("mouth") | model.region("mouth_cavity"))[model.faces].all(1)
    used, local = np.unique(model.faces[patch], return_inverse=True)
    border = np.intersect1d(used, model.faces[~patch])
    anchors, targets = [border], [V[border]]
    for rim, other in ((upper, lower), (lower, upper)):
        inner = rim[1:-1]  # the corners belong to both
        too_far = (_across(model, V, rim, other) - width[0] / width[1] * _across(model, rest, rim, other))[1:-1]
        free = ~np.isin(inner, border)  # some are part of it where the model does not tell what lies behind the lips
        anchors.append(inner[free])
        targets.append(V[inner[free]] + 0.5 * share * too_far[free])
    at = np.concatenate(anchors)
    result = V.copy()
    result[used] = laplacian_align(
        V[used], local.reshape(-1, 3), np.searchsorted(used, at), np.vstack(targets), weight=_WEIGHT
    )
    return result


def _across(model: MorphableModel, V: np.ndarray, rim: np.ndarray, other: np.ndarray) -> np.ndarray:
    """From each vertex of a rim (k, 3) to the place on the other that it meets when the template's mouth closes."""
    at, there = arc_shares(model.mean[rim]), arc_shares(model.mean[other])
    return interpolated(at, there, V[other]) - V[rim]
