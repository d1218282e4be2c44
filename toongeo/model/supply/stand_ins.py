"""Which parts a model has, and what stands in for those that it has not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from toongeo.model.ibug68 import PARTS
from toongeo.model.mirrored_vertices import mirrored_vertices

if TYPE_CHECKING:
    from toongeo.model.morphable_model import MorphableModel

__all__ = ["has_part", "stand_ins"]

_GREY = 0.6  # sRGB of a model without colours: of the lightness of skin, without its hue
_ARRAYS = ("landmarks", "quads", "uv", "uv_faces", "eyes", "albedo")


def stand_ins(model: MorphableModel) -> dict[str, Any]:
    """What takes the place of fields that were not given."""
    n = len(model.mean)
    empty: dict[str, np.ndarray] = {
        "expression": np.zeros((0, n, 3), np.float32),
        "albedo": np.zeros((0, n, 3), np.float32),
        "quads": np.zeros((0, 4), np.int64),
        "uv": np.zeros((0, 2)),
        "uv_faces": np.zeros((0, 3), np.int64),
    }
    values: dict[str, Any] = {name: array for name, array in empty.items() if not getattr(model, name).size}
    if not model.albedo_mean.size:
        values["albedo_mean"] = np.full((n, 3), _GREY, np.float32)
    if not model.contour_lines:
        values["contour_lines"] = tuple(model.landmarks[k : k + 1] for k in PARTS["jaw"])
    if not model.mirror.size:
        values["mirror"] = mirrored_vertices(model.mean)
    return values


def has_part(model: MorphableModel, name: str) -> bool:
    """Whether a model has one part: see :meth:`toongeo.MorphableModel.has`."""
    if name == "expression":
        return model.n_named > 0
    if name == "contours":
        return any(len(line) > 1 for line in model.contour_lines)
    if name == "skinning":
        return model.skinning is not None
    if name in _ARRAYS:
        return len(getattr(model, name)) > 0
    known = model.expression_names[: model.n_named]
    return name in known or (name in model.regions and bool(model.regions[name].any()))
