"""Models in a file of our own, and back."""

from __future__ import annotations

import io
import json
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io import atomic_write
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.face_prior import FacePrior
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.skinning import Skinning
from toongeo.reading.check_file import file_name
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import npz_names, read_npz

__all__ = ["is_own_model", "load_own_model", "save_model"]

_VERSION = 1
_KEY = "toongeo_model"
_ARRAYS = (
    "mean", "faces", "identity", "landmarks", "quads", "expression", "albedo_mean", "albedo", "mirror", "uv",
    "uv_faces",
)  # fmt: skip
_EYE_NUMBERS = ("radius", "iris_angle", "pupil_angle")
_LARGEST = 10**7  # vertices


def save_model(model: MorphableModel, path: str | Path) -> None:
    """Write a model to an ``.npz``, from which :func:`toongeo.load_model` gives it back bit for bit.

    The file holds arrays only, not packed: ``toongeo_model`` is its version and, as JSON, the names in it; the fields
    of :class:`toongeo.MorphableModel` bear their names; ``regions`` are bits, (r, n / 8) uint8; ``contour_lines`` lie
    end to end with ``contour_starts`` (18,); ``eye0_*`` and ``eye1_*``, ``skinning_*`` and ``prior_*`` are the fields
    of :class:`toongeo.model.EyeballTemplate` and the like. Files of the same model are the same.

    Parameters
    ----------
    model : MorphableModel
    path : str or Path
        ``.npz``.

    Raises
    ------
    ValueError
        If the name does not end in ``.npz``.
    OSError
        If it cannot be written; what was there before stays.

    Examples
    --------
    >>> import toongeo as tg
    >>> tg.save_model(tg.default_model(), "head.npz")
    >>> bool((tg.load_model("head.npz").mean == tg.default_model().mean).all())
    True
    """
    path = file_name(path)
    if path.suffix != ".npz":
        raise ValueError(f"path: expected a name that ends in .npz, got {path.name}")
    header = {
        "version": _VERSION,
        "expression_names": list(model.expression_names),
        "n_named": model.n_named,
        "regions": list(model.regions),
        "eyes": len(model.eyes),
        "joints": list(model.skinning.names) if model.skinning is not None else None,
        "prior": model.prior is not None,
    }
    arrays: dict[str, Any] = {_KEY: np.array(json.dumps(header))}
    arrays |= {name: getattr(model, name) for name in _ARRAYS}
    arrays["regions"] = np.packbits(np.array([*model.regions.values()], bool).reshape(-1, len(model.mean)), axis=1)
    arrays["contour_lines"] = np.concatenate(model.contour_lines)
    arrays["contour_starts"] = np.cumsum([0, *map(len, model.contour_lines)])
    for k, eye in enumerate(model.eyes):
        arrays |= {f"eye{k}_{part.name}": getattr(eye, part.name) for part in fields(eye)}
    for name, value in (("skinning", model.skinning), ("prior", model.prior)):
        if value is not None:
            given = {part.name: getattr(value, part.name) for part in fields(value) if part.name != "names"}
            arrays |= {f"{name}_{part}": array for part, array in given.items() if array is not None}
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    atomic_write({path: stream.getvalue()})


def is_own_model(path: Path) -> bool:
    """Whether an archive is of :func:`save_model`."""
    return _KEY in npz_names(path)


def load_own_model(path: Path) -> MorphableModel:
    """A model of :func:`save_model`.

    Raises
    ------
    ValueError
        If it is none, of a later version, sizes do not fit, numbers are not finite or indices out of range.
    """
    with promise(path, "a model of toongeo", alone=True):
        z = read_npz(path, expected="a model of toongeo")
        header = json.loads(str(z[_KEY][()]))
        if header["version"] != _VERSION:
            raise ValueError(f"{path}: expected version {_VERSION} of a model, got {header['version']}")
        model = MorphableModel(
            **{name: z[name] for name in _ARRAYS},
            expression_names=tuple(str(name) for name in header["expression_names"]),
            n_named=int(header["n_named"]),
            regions=_regions(z, header["regions"]),
            contour_lines=_lines(z),
            eyes=tuple(_eye(z, k) for k in range(int(header["eyes"]))),
            skinning=_skinning(z, header["joints"]),
            prior=_prior(z) if header["prior"] else None,
        )
        _check(model)
        return model


def _parts(z: dict[str, NDArray], prefix: str) -> dict[str, Any]:
    return {name.removeprefix(prefix): value for name, value in z.items() if name.startswith(prefix)}


def _regions(z: dict[str, NDArray], names: list[str]) -> dict[str, NDArray[np.bool_]]:
    bits = np.unpackbits(z["regions"], axis=1, count=len(z["mean"])).astype(bool)
    return dict(zip(map(str, names), bits, strict=True))


def _lines(z: dict[str, NDArray]) -> tuple[NDArray, ...]:
    starts = z["contour_starts"]
    if starts[0] != 0 or (np.diff(starts) < 0).any() or starts[-1] != len(z["contour_lines"]) or len(starts) != 18:
        raise ValueError("contour_starts: expected 18 ascending places")
    return tuple(np.split(z["contour_lines"], starts[1:-1]))


def _eye(z: dict[str, NDArray], k: int) -> EyeballTemplate:
    parts = _parts(z, f"eye{k}_")
    return EyeballTemplate(**{**parts, **{name: float(parts[name]) for name in _EYE_NUMBERS}})


def _prior(z: dict[str, NDArray]) -> FacePrior:
    parts = _parts(z, "prior_")
    if "n_principal" in parts:
        parts["n_principal"] = int(parts["n_principal"])
    return FacePrior(**parts)


def _skinning(z: dict[str, NDArray], names: list[str] | None) -> Skinning | None:
    return None if names is None else Skinning(names=tuple(map(str, names)), **_parts(z, "skinning_"))


def _check(model: MorphableModel) -> None:
    """That all arrays belong to one mesh."""
    n, m, k = len(model.mean), len(model.faces), len(model.identity)
    shapes: dict[str, tuple[tuple[int | None, ...], str]] = {
        "mean": ((n, 3), "f"), "faces": ((m, 3), "i"), "identity": ((k, n, 3), "f"), "landmarks": ((None,), "i"),
        "quads": ((None, 4), "i"), "expression": ((len(model.expression_names), n, 3), "f"),
        "albedo_mean": ((n, 3), "f"), "albedo": ((None, n, 3), "f"), "mirror": ((n,), "i"), "uv": ((None, 2), "f"),
        "uv_faces": ((None, 3), "i"),
    }  # fmt: skip
    limits = {"uv_faces": len(model.uv)}
    for name, (shape, kind) in shapes.items():
        array = getattr(model, name)
        fits = array.ndim == len(shape) and all(b in (None, a) for a, b in zip(array.shape, shape, strict=True))
        if not fits or array.dtype.kind != kind:
            raise ValueError(f"{name}: expected {shape}, got {array.dtype} of shape {array.shape}")
        if kind == "f" and not np.isfinite(array).all():
            raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")
        if kind == "i" and array.size and not 0 <= array.min() <= array.max() < limits.get(name, n):
            raise ValueError(f"{name}: expected indices below {limits.get(name, n)}")
    lines = np.concatenate(model.contour_lines)
    if not 3 <= n <= _LARGEST or not m or model.landmarks.size not in (0, 68) or len(model.uv_faces) not in (0, m):
        raise ValueError(f"mean: expected a mesh with 68 landmarks or none, got {n} vertices and {m} triangles")
    if not 0 <= model.n_named <= len(model.expression_names) or (
        lines.size and not 0 <= lines.min() <= lines.max() < n
    ):
        raise ValueError("n_named, contour_lines: expected numbers in range")
    for eye in model.eyes:
        if eye.centre_modes.shape != (k, 3) or eye.radius_modes.shape != (k,) or eye.centre.shape != (3,):
            raise ValueError(f"eyes: expected modes of {k} coefficients, got {eye.centre_modes.shape}")
        p = len(eye.vertices)
        if eye.uv.shape != (p, 2) or eye.colour.shape != (p, 3) or not 0 <= eye.faces.min() <= eye.faces.max() < p:
            raise ValueError("eyes: expected a mesh with coordinates and colours")
    if model.skinning is not None and model.skinning.weights.shape[0] != n:
        raise ValueError(f"skinning: expected {n} vertices, got {model.skinning.weights.shape[0]}")
