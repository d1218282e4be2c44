"""Whether the arrays of a model fit together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from toongeo.model.morphable_model import MorphableModel

__all__ = ["check_model"]

_LANDMARKS = 68
# Of each array: its columns behind the first axis ("n": as many as vertices), and what its numbers index.
_SHAPES = {
    "mean": (3,),
    "identity": ("n", 3),
    "expression": ("n", 3),
    "albedo_mean": (3,),
    "albedo": ("n", 3),
    "uv": (2,),
    "faces": (3,),
    "quads": (4,),
    "uv_faces": (3,),
    "landmarks": (),
    "mirror": (),
}
_INDICES = {"faces": "mean", "quads": "mean", "uv_faces": "uv", "landmarks": "mean", "mirror": "mean"}


def check_model(model: MorphableModel) -> None:
    """Refuse arrays of other shapes, numbers that are not finite, and indices out of range; empty ones were not given.

    Raises
    ------
    ValueError
        Names the array, what was expected and what came.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> check_model(default_model())
    """
    for name, columns in _SHAPES.items():
        array = np.asarray(getattr(model, name))
        if array.size or name == "mean":
            _check_numbers(name, array, tuple(len(model.mean) if k == "n" else k for k in columns))
    for name, into in _INDICES.items():
        _check_indices(name, np.asarray(getattr(model, name)), len(getattr(model, into)))
    for name, rows in (("landmarks", _LANDMARKS), ("mirror", len(model.mean)), ("albedo_mean", len(model.mean))):
        found = len(getattr(model, name))
        if found not in (0, rows):
            raise ValueError(f"{name}: expected {rows} rows, got {found}")
    modes = len(model.expression) if model.expression.size else 0
    if len(model.expression_names) not in (0, modes) or not 0 <= model.n_named <= modes:
        named = f"{len(model.expression_names)} names of which {model.n_named} are FACS units"
        raise ValueError(f"expression_names: expected one for each of {modes} modes, got {named}")
    for region, mask in model.regions.items():
        if np.shape(mask) != (len(model.mean),):
            raise ValueError(f"regions: expected ({len(model.mean)},) truth values in {region!r}, got {np.shape(mask)}")


def _check_numbers(name: str, array: np.ndarray, columns: tuple[int | str, ...]) -> None:
    expected = ", ".join(map(str, ("k", *columns))) + ("" if columns else ",")
    if array.dtype.kind not in ("iu" if name in _INDICES else "iuf"):
        raise ValueError(f"{name}: expected {'indices' if name in _INDICES else 'numbers'}, got {array.dtype}")
    if array.ndim != len(columns) + 1 or array.shape[1:] != columns:
        raise ValueError(f"{name}: expected shape ({expected}), got {array.shape}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise ValueError(f"{name}: expected finite numbers, got NaN or infinity")


def _check_indices(name: str, array: np.ndarray, count: int) -> None:
    if array.size and not 0 <= array.min() <= array.max() < count:
        what = "vertices" if _INDICES[name] == "mean" else "texture coordinates"
        raise ValueError(f"{name}: expected {what} in 0..{count - 1}, got {array.min()} to {array.max()}")
