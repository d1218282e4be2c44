"""ICT-FaceKit as a morphable model."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import npz_names, read_npz

__all__ = ["ict_model", "is_ict_facekit", "load_ict_facekit", "own_name", "packed_ict"]

_MM = 10.0  # the file is in centimetres
_INT16 = 32767
_N_SKIN, _N_NARROW, _N_FACE = 11248, 6706, 9409  # the vertex order of the topology: narrow face, face, head and neck
_EYEBALLS = slice(21451, 23021), slice(23021, 24591)  # left, right


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

    Returns
    -------
    MorphableModel

    Raises
    ------
    ValueError
        If an array is missing or the vertices are not those of the ICT-FaceKit topology.

    References
    ----------
    R. Li et al., "Learning formation of physically-based face attributes", CVPR 2020 (ICT-FaceKit, MIT license).

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.load_ict_facekit("ict.npz")  # doctest: +SKIP
    >>> import numpy as np
    >>> np.savez("other.npz", neutral=np.zeros((4, 3)))
    >>> tg.load_ict_facekit("other.npz")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    ValueError: path: expected an archive of ICT-FaceKit, got no 'expression_names', ...
    """
    path = Path(path)
    z: dict[str, Any] = dict(read_npz(path, _KEYS, expected="an archive of ICT-FaceKit"))
    with promise(path, "an archive of ICT-FaceKit", alone=True):
        for kind in ("identity", "expression"):
            integers, scale = z.pop(f"{kind}_q"), z.pop(f"{kind}_scale")
            if integers.ndim != 3 or scale.shape != integers.shape[:1] or integers.shape[1:] != z["neutral"].shape:
                raise ValueError(f"{kind}_q: expected (k, v, 3) with k scales, got {integers.shape} and {scale.shape}")
            # Multiplied in float32 as a whole, so that a face is the same whichever of its vertices are kept.
            z[kind] = integers[:, :_N_SKIN].astype(np.float32) * (_MM * scale[:, None, None]).astype(np.float32)
        return ict_model(path, z, mode_unit=1.0)


def is_ict_facekit(path: Path) -> bool:
    """Whether an archive is ICT-FaceKit."""
    return set(npz_names(path)) >= _KEYS


def ict_model(path: Path, z: dict[str, Any], mode_unit: float = _MM) -> MorphableModel:
    """The model of arrays as in the archive, with ``identity`` and ``expression`` (k, v, 3) as numbers of any unit."""
    if len(z["neutral"]) < _EYEBALLS[1].stop:
        raise ValueError(f"path: expected at least {_EYEBALLS[1].stop} vertices, got {len(z['neutral'])}")
    neutral = _MM * z["neutral"].astype(float)
    origin = np.mean([(ball.min(0) + ball.max(0)) / 2 for ball in (neutral[part] for part in _EYEBALLS)], axis=0)
    faces, quads, uv_faces = _skin(z["quads"].astype(np.int64), z["quads_uv"].astype(np.int64))
    names = [own_name(str(name)) for name in z["expression_names"]]
    return MorphableModel.from_arrays(
        neutral[:_N_SKIN],
        faces,
        origin=origin,
        quads=quads,
        identity=z["identity"][:, :_N_SKIN] * np.float32(mode_unit),
        expression=z["expression"][:, :_N_SKIN] * np.float32(mode_unit),
        expression_names=names,
        landmarks=z["landmarks68"].astype(np.int64),
        regions={"narrow_face": np.arange(_N_SKIN) < _N_NARROW, "face": np.arange(_N_SKIN) < _N_FACE},
        uv=z["uv"].astype(float),
        uv_faces=uv_faces,
    )


def packed_ict(z: dict[str, Any]) -> bytes:
    """The archive of arrays that :func:`ict_model` takes: differences as 16-bit integers, each with its scale."""
    arrays = {name: value for name, value in z.items() if name not in ("identity", "expression")}
    for kind in ("identity", "expression"):
        scale = np.abs(z[kind]).max(axis=(1, 2), initial=1e-12).astype(np.float64) / _INT16
        arrays |= {f"{kind}_q": np.rint(z[kind] / scale[:, None, None]).astype(np.int16), f"{kind}_scale": scale}
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


_KEYS = {
    "neutral", "quads", "quads_uv", "uv", "identity_q", "identity_scale",
    "expression_q", "expression_scale", "expression_names", "landmarks68",
}  # fmt: skip


def own_name(name: str) -> str:
    """``eyeBlink_L`` -> ``eyeBlinkLeft``."""
    for suffix, side in (("_L", "Left"), ("_R", "Right")):
        name = name.removesuffix(suffix) + side if name.endswith(suffix) else name
    return name


def _skin(
    quads: NDArray[np.int64], uv_quads: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Triangles, whole quads, and triangles of the texture coordinates, all of the skin."""
    if quads.ndim != 2 or quads.shape[1:] != (4,) or uv_quads.shape != quads.shape or quads.min(initial=0) < -1:
        raise ValueError(f"quads: expected (q, 4) vertices and as many of the texture, got {quads.shape}")
    kept = quads.max(axis=1) < _N_SKIN
    quads, uv_quads = quads[kept], uv_quads[kept]
    whole = quads[:, 3] >= 0

    def halves(q: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.ascontiguousarray(np.vstack([q[:, [0, 1, 2]], q[whole][:, [0, 2, 3]]]))

    return halves(quads), quads[whole], halves(uv_quads)
