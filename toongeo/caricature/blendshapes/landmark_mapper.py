"""From the landmarks of a drawing to those of a normal face and back, without a network.

Constants were judged on faces of the deformation space and four pictures (``benchmarks/caricature_expressions.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import Delaunay

from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats
from toongeo.caricature.blendshapes.sparse_expression import sparse_expression
from toongeo.io.landmark_array import landmark_array
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.default_model import default_model
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS, PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline import PriorOptions
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions

__all__ = ["Exaggeration", "PartMapper"]

# A face as exaggerated as the drawing asks for: a large identity is cheap, a misfit is not.
_FREE = FitOptions(prior_weight=1e-6, prior=PriorOptions(max_deviation=12.0, identity_weight=0.05))
_SPREAD = 2.0  # standard deviation of the identities of caricatures
_STIFFNESS = 0.3  # pulls a part's affine frame towards a similarity
_CHIN = 4.0  # jaw points from the chin over which the jaw follows the mouth
_SHARE = 0.5  # power of a part's growth beside the whole face's that its motions take: room grows less than parts
_ROOM = 0.5  # of the share of the area between parts that an expression leaves in the normal face
_SLIVER = 0.1  # height to length below which a triangle tells nothing about room
_SHARES = 1.0, 0.9, 0.8, 0.7, 0.6, 0.5  # of the motion, tried in turn until enough room is left


@dataclass(frozen=True, eq=False)
class Exaggeration:
    """How a drawing differs from a normal face: what `PartMapper.to_caricature` applies.

    Attributes
    ----------
    normal, drawn : (68, 2) float64, px
        The normal face, and the drawing's landmarks.
    frames : (68, 2, 2) float64
        How a displacement of each landmark of the normal face shows in the drawing.
    between : (t, 3) int64
        Triangles of landmarks between the parts of the drawing: the room that expressions have.
    """

    normal: Floats
    drawn: Floats
    frames: Floats
    between: NDArray[np.int64]

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "normal", "drawn", "frames", "between")


class PartMapper:
    """The default `LandmarkMapper`: a frame for each part of the face.

    F+ gives the nearest plausible face of the model with the expression of the drawing. A fit in which identities
    may be as large as the drawing asks for separates the exaggeration, which is identity, from the expression; then
    the identity is brought back among people. F- moves every landmark of the drawing as that of the normal face
    moved, in the frame of its part: tall eyes close by more, and a wide mouth opens widely. The chin goes with the
    mouth, the rest of the jaw with the whole face. Lids and lips meet and do not cross, and a mouth right under a
    nose does not smile into it.

    Parameters
    ----------
    model : MorphableModel, optional
        `default_model` if None.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> model, mapper = default_model(), PartMapper()
    >>> drawn = ScaledOrthographicCamera.look().project(model.mean[model.landmarks]) * [1.0, 1.2]
    >>> normal, context = mapper.to_normal(drawn)
    >>> bool(np.abs(mapper.to_caricature(normal, context) - drawn).max() < 1e-9)
    True
    """

    def __init__(self, model: MorphableModel | None = None) -> None:
        self.model = default_model() if model is None else model

    def to_normal(self, landmarks: ArrayLike) -> tuple[Floats, Exaggeration]:
        """F+: landmarks (68, 2) of the nearest plausible face, px of the same picture, and what F- needs.

        Missing landmarks (NaN rows) are filled in, in both.

        Raises
        ------
        ValueError
            If the landmarks have another shape, hold infinities, or are too few for a fit.
        """
        drawn = landmark_array(landmarks)
        face = sparse_expression(fit_3dmm(None, drawn, model=self.model, options=_FREE), drawn, spread=_SPREAD)
        normal = _landmarks(face, _plausible(face))
        frames, scale = _part_frames(normal, drawn)
        missing = ~np.isfinite(drawn).all(axis=1)
        drawn[missing] = _whole(normal, drawn, scale)[missing]
        return normal, Exaggeration(normal, drawn, frames, _between(drawn))

    def to_caricature(self, normal: ArrayLike, context: Exaggeration) -> Floats:
        """F-: landmarks (68, 2), px, of the drawing when the normal face has these.

        Raises
        ------
        ValueError
            If the landmarks have another shape, are missing or hold infinities.
        """
        points = landmark_array(normal)
        if not np.isfinite(points).all():
            raise ValueError("normal: expected 68 landmarks, none of them missing, got NaN")
        motion = np.einsum("kab,kb->ka", context.frames, points - context.normal)
        return _rims_in_order(context.drawn + _fitting(motion, points, context) * motion, context.drawn)


def _plausible(face: FaceFit) -> Floats:
    """Identity (k,) of a face, brought back to where people are: sqrt(k) deviations from the likeliest face."""
    centre = 0.0 if face.model.prior is None else face.model.prior.mean
    offset = face.identity - centre
    return np.asarray(centre + offset * min(1.0, np.sqrt(len(offset)) / max(float(np.linalg.norm(offset)), 1e-12)))


def _landmarks(face: FaceFit, identity: Floats) -> Floats:
    """Where an annotator would put the landmarks (68, 2) of the face with another identity."""
    points = face.model.vertices(identity, face.expression)[face.landmark_vertices]
    return face.project(points if face.model.prior is None else points + face.model.prior.landmark_offsets)


def _part_frames(normal: Floats, drawn: Floats) -> tuple[Floats, complex]:
    """Frames (68, 2, 2) of the landmarks, and scale and rotation of the whole as a complex number."""
    whole = _turn_and_scale(normal, drawn)
    frames = np.tile(_matrix(whole), (68, 1, 1))
    for part, points in PARTS.items():
        if part != "jaw":
            frames[points] = _frame(normal[points], drawn[points], whole)
    jaw = PARTS["jaw"]
    share = np.exp(-(((np.arange(len(jaw)) - len(jaw) // 2) / _CHIN) ** 2))[:, None, None]
    frames[jaw] = share * frames[PARTS["mouth"][0]] + (1 - share) * frames[jaw]
    return frames, whole


def _frame(normal: Floats, drawn: Floats, whole: complex) -> Floats:
    """Affine frame (2, 2) of one part, pulled towards the part's size and the whole face's rotation."""
    seen = np.isfinite(drawn).all(axis=1)
    if seen.sum() < 3:
        return _matrix(whole)
    a, b = normal[seen] - normal[seen].mean(0), drawn[seen] - drawn[seen].mean(0)
    gram = a.T @ a
    pull = _STIFFNESS * np.trace(gram) / 2
    size = np.sqrt((b**2).sum() / max(float((a**2).sum()), 1e-12))
    matrix = (b.T @ a + pull * _matrix(whole / abs(whole) * size)) @ np.linalg.inv(gram + pull * np.eye(2))
    U, singular, Vt = np.linalg.svd(matrix)
    growth = np.clip(singular / abs(whole), 0.1, 10.0) ** _SHARE
    return np.asarray((U * (abs(whole) * growth)) @ Vt)


def _turn_and_scale(normal: Floats, drawn: Floats) -> complex:
    """Best similarity between landmarks, without its shift."""
    seen = np.isfinite(drawn).all(axis=1)
    a, b = ((points[seen] - points[seen].mean(0)) @ [1, 1j] for points in (normal, drawn))
    return complex((a.conj() @ b) / (a.conj() @ a))


def _matrix(z: complex) -> Floats:
    return np.array([[z.real, -z.imag], [z.imag, z.real]])


def _whole(normal: Floats, drawn: Floats, z: complex) -> Floats:
    """The normal landmarks brought onto the drawing by one similarity."""
    seen = np.isfinite(drawn).all(axis=1)
    return (normal - normal[seen].mean(0)) @ _matrix(z).T + drawn[seen].mean(0)


def _between(drawn: Floats) -> NDArray[np.int64]:
    """Triangles (t, 3) of landmarks, Delaunay, that span parts of the face and are no slivers."""
    part = np.empty(68, np.int64)
    for k, points in enumerate(PARTS.values()):
        part[points] = k
    triangles = Delaunay(drawn).simplices.astype(np.int64)
    longest = np.linalg.norm(drawn[triangles] - drawn[np.roll(triangles, 1, axis=1)], axis=2).max(axis=1)
    wide = np.abs(_areas(drawn, triangles)) > _SLIVER * longest**2
    inner = ~np.isin(triangles, PARTS["jaw"]).any(axis=1)  # the outline gives way
    return triangles[wide & inner & (np.ptp(part[triangles], axis=1) > 0)]


def _areas(points: Floats, triangles: NDArray[np.int64]) -> Floats:
    """Twice the signed areas (t,)."""
    a, b, c = points[triangles].transpose(1, 2, 0)
    return np.asarray((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _fitting(motion: Floats, normal: Floats, context: Exaggeration) -> float:
    """Share of a motion (68, 2) that leaves room between the parts: a mouth under a nose does not smile into it.

    Of the room that the normal face (68, 2) keeps, the drawing keeps a good part too.
    """
    kept = np.minimum(_areas(normal, context.between) / _areas(context.normal, context.between), 1.0)
    room = _areas(context.drawn, context.between)
    for share in _SHARES:
        if (_areas(context.drawn + share * motion, context.between) / room > _ROOM * kept).all():
            return share
    return _SHARES[-1]


def _rims_in_order(moved: Floats, drawn: Floats) -> Floats:
    """Lids and lips that would cross meet halfway; pairs that cross in the drawing may stay so."""
    moved = moved.copy()
    for upper, lower in _facing():
        across = drawn[upper[-1]] - drawn[upper[0]]
        down = np.array([-across[1], across[0]]) / max(float(np.linalg.norm(across)), 1e-12)
        for u, v in zip(upper[1:-1], lower[1:-1], strict=True):
            least = min(0.0, float((drawn[v] - drawn[u]) @ down))
            lacking = max(0.0, least - float((moved[v] - moved[u]) @ down))
            moved[u] -= lacking / 2 * down
            moved[v] += lacking / 2 * down
    return moved


def _facing() -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Upper and lower rims that touch when closed, from corner to corner."""
    lids = [(LID_RIMS[f"lid_upper_{side}"], LID_RIMS[f"lid_lower_{side}"]) for side in SIDES]
    return [*lids, (LIP_RIMS["lip_upper_inner"], LIP_RIMS["lip_lower_inner"])]
