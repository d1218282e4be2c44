"""ICT-FaceKit as a morphable model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model.loaders.foreign_model import named_parts
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promised
from toongeo.reading.read_npz import read_npz

__all__ = ["load_ict_facekit"]

_MM = 10.0  # the file is in centimetres
_N_SKIN, _N_NARROW, _N_FACE = 11248, 6706, 9409  # the vertex order of the topology: narrow face, face, head and neck
_EYEBALLS = slice(21451, 23021), slice(23021, 24591)  # left, right


@promised("the arrays of ICT-FaceKit")
def load_ict_facekit(path: str | Path) -> MorphableModel:
    """ICT-FaceKit's skin (face, head and neck) from one compressed archive.

    The frame becomes that of this library: millimetres, origin midway between the eyeballs. A unit of an
    identity mode stays one standard deviation. The static vertices of the annotation are the landmarks, and
    their jaw points do not slide. Expressions bear our names: ``eyeBlink_L`` is ``eyeBlinkLeft``. There are no
    eyeballs, no inside of the mouth, and the skin is grey.

    Parameters
    ----------
    path : str or Path
        ``.npz`` with ``neutral (v, 3)`` cm, ``quads (q, 4)`` (a triangle ends in -1), ``quads_uv``, ``uv (t, 2)``,
        ``identity_q (k, v, 3)`` and ``expression_q (e, v, 3)`` as integers with their ``*_scale`` (k,) and (e,),
        ``expression_names`` and ``landmarks68``.

    Raises
    ------
    ValueError
        If an array is missing or the vertices are not those of the ICT-FaceKit topology.

    References
    ----------
    R. Li et al., "Learning formation of physically-based face attributes", CVPR 2020 (ICT-FaceKit, MIT license).
    """
    z = read_npz(path, sorted(_KEYS), expected="the arrays of ICT-FaceKit")
    if len(z["neutral"]) < _EYEBALLS[1].stop:
        raise ValueError(f"path: expected at least {_EYEBALLS[1].stop} vertices, got {len(z['neutral'])}")
    neutral = _MM * z["neutral"].astype(float)
    origin = np.mean([(ball.min(0) + ball.max(0)) / 2 for ball in (neutral[part] for part in _EYEBALLS)], axis=0)
    mean = neutral[:_N_SKIN] - origin
    faces, quads, uv_faces = _skin(z["quads"].astype(np.int64), z["quads_uv"].astype(np.int64))
    landmarks = z["landmarks68"].astype(np.int64)
    return MorphableModel(
        mean=mean,
        faces=faces,
        quads=quads,
        identity=_modes(z["identity_q"], z["identity_scale"]),
        expression=_modes(z["expression_q"], z["expression_scale"]),
        expression_names=tuple(_own_name(str(name)) for name in z["expression_names"]),
        n_named=len(z["expression_names"]),
        landmarks=landmarks,
        regions={
            "narrow_face": np.arange(_N_SKIN) < _N_NARROW,
            "face": np.arange(_N_SKIN) < _N_FACE,
            **named_parts(mean, landmarks),
        },
        uv=z["uv"].astype(float),
        uv_faces=uv_faces,
    )


_KEYS = {
    "neutral", "quads", "quads_uv", "uv", "identity_q", "identity_scale",
    "expression_q", "expression_scale", "expression_names", "landmarks68",
}  # fmt: skip


def _own_name(name: str) -> str:
    for suffix, side in (("_L", "Left"), ("_R", "Right")):
        name = name.removesuffix(suffix) + side if name.endswith(suffix) else name
    return name


def _modes(integers: NDArray[np.integer], scale: NDArray[np.float64]) -> NDArray[np.float32]:
    return integers[:, :_N_SKIN].astype(np.float32) * (_MM * scale[:, None, None]).astype(np.float32)


def _skin(
    quads: NDArray[np.int64], uv_quads: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Triangles, whole quads, and triangles of the texture coordinates, all of the skin."""
    kept = quads.max(axis=1) < _N_SKIN
    quads, uv_quads = quads[kept], uv_quads[kept]
    whole = quads[:, 3] >= 0

    def halves(q: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.ascontiguousarray(np.vstack([q[:, [0, 1, 2]], q[whole][:, [0, 2, 3]]]))

    return halves(quads), quads[whole], halves(uv_quads)
