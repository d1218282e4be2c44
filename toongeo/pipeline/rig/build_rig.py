"""The named expressions of the template, transferred to a new face."""

import time
from functools import lru_cache
from typing import Literal

import numpy as np

from toongeo.geometry import DeformationTransfer
from toongeo.geometry.rotations.similarity import similarity
from toongeo.geometry.source_motion import SourceMotion, source_motion
from toongeo.model import MorphableModel
from toongeo.model.anatomy.motion_shares import motion_shares
from toongeo.model.anatomy.still_vertices import still_vertices
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.feature_gains import feature_gains
from toongeo.pipeline.rig.rig import Rig, RigReport
from toongeo.pipeline.rig.split_gaze import split_gaze

__all__ = ["AT_ONCE", "build_rig"]

AT_ONCE = 5  # expressions solved for together: 15 right-hand sides still fit the cache


def build_rig(face: AlignedFace, *, gain: float | Literal["auto"] = 1.0) -> Rig:
    """Expressions of the template's mean face, transferred to this face (Pan et al. 2024, section 3.3).

    The face is taken for neutral; :func:`neutral_face` makes it so. The gradients of each template expression are
    carried over by :class:`toongeo.DeformationTransfer`; vertices that no expression moves on the template (skull,
    neck, ears) are pinned, and the template is turned onto the face first. Where the template is still in an
    expression, so is the face: displacements fade out with the template's own
    (:func:`~toongeo.model.anatomy.motion_shares.motion_shares`).

    Parameters
    ----------
    face : AlignedFace
    gain : float or "auto"
        Strength of the expressions: gradients Q are carried over as ``I + gain (Q - I)``. Since the system is linear in
        them and the pins do not move, that multiplies the blendshapes. "auto" chooses a gain for each expression, by
        which its feature (mouth, eye, brow, nose) travels as far in proportion to its own size as on the template;
        see :func:`~toongeo.pipeline.rig.feature_gains.feature_gains`.

    Returns
    -------
    Rig
        With the ``model.n_named`` named expressions of the model, which may be none. Shapes of the model that have
        names of ``GAZE_NAMES`` are how its skin follows the gaze; of one without nothing does yet.

    Raises
    ------
    ValueError
        If the gain is neither "auto" nor a positive number, or the face has other vertices than its model.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig = tg.build_rig(face)
    >>> len(rig.names), rig.deltas.shape
    (46, (46, 19057, 3))
    >>> chin = face.model.landmarks[8]
    >>> bool(rig.vertices({"jawOpen": 1.0})[chin, 1] < rig.neutral[chin, 1])
    True
    """
    started = time.perf_counter()
    if gain != "auto" and not (isinstance(gain, float | int) and 0 < gain < np.inf):
        raise ValueError(f"gain: expected a positive number or 'auto', got {gain!r}")
    model = face.model
    if face.vertices.shape != model.mean.shape:
        raise ValueError(
            f"face: expected vertices of shape {model.mean.shape}, one for each of its model,"
            f" got {face.vertices.shape}; another mesh has to be registered first"
        )
    deltas = _transferred(face, gain) if model.n_named else np.zeros((0, *face.vertices.shape), np.float32)
    names, deltas, gaze = split_gaze(model.expression_names[: model.n_named], deltas)
    return Rig(
        names=names,
        neutral=face.vertices,
        deltas=deltas,
        gaze=gaze,
        pose=np.zeros(len(names)),
        report=RigReport(time.perf_counter() - started),
    )


def _transferred(face: AlignedFace, gain: float | Literal["auto"]) -> np.ndarray:
    """Displacements (k, n, 3) float32 of the named expressions."""
    model = face.model
    transfer = DeformationTransfer(model.mean, model.faces, face.vertices, pinned=still_vertices(model), align=True)
    deltas = np.empty((model.n_named, *face.vertices.shape), np.float32)
    motions = _motions(model)
    for start in range(0, len(deltas), AT_ONCE):
        deltas[start : start + AT_ONCE] = transfer.displacements(motions[start : start + AT_ONCE])
    _end_with(model, face.vertices, deltas)
    gains = feature_gains(model, face.vertices, deltas) if gain == "auto" else np.full(len(deltas), float(gain))
    if (gains != 1).any():
        deltas *= gains.astype(np.float32)[:, None, None]
    return deltas


def _end_with(model: MorphableModel, V: np.ndarray, deltas: np.ndarray) -> None:
    """Let displacements end where the template's do, in place: what they are beyond those, in its size, fades out.

    Gradients add up: where a face is drawn unlike the template, what they carry does not end by itself.
    """
    scale, rotation, _ = similarity(model.mean, V)
    turn = (scale * rotation.T).astype(np.float32)
    for delta, shape, share in zip(deltas, model.expression, motion_shares(model), strict=False):
        own = shape @ turn
        delta[:] = own + share[:, None] * (delta - own)


@lru_cache(maxsize=4)
def _motions(model: MorphableModel) -> tuple[SourceMotion, ...]:
    """Of the template's mean face in its named expressions: the same for every target."""
    corners = np.ascontiguousarray(model.faces.T)
    return tuple(source_motion(model.mean, corners, shape) for shape in model.expression[: model.n_named])
