"""Landmarks for a model that has none, or others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from toongeo.model.ibug68 import PARTS
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.eye_frame import eye_origin
from toongeo.model.supply.named_parts import named_parts

__all__ = ["with_landmarks"]


def with_landmarks(model: MorphableModel, vertices: ArrayLike) -> MorphableModel:
    """A model with these vertices as its 68 landmarks.

    Unless it has eyeballs, which say where the origin is, that moves midway between the eyes. Masks of eyes, nose and
    mouth that it does not have are drawn about the landmarks. Contour lines of the model before are dropped if its
    landmarks change.

    Parameters
    ----------
    model : MorphableModel
    vertices : (68,) int

    Raises
    ------
    ValueError
        If these are not 68 vertices of the model.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> template = default_model()
    >>> bare = MorphableModel.from_arrays(template.mean, template.faces)
    >>> model = bare.with_landmarks(template.landmarks)
    >>> model.has("landmarks", "mouth"), bool(abs(model.mean[model.landmarks[[36, 45]], 1]).max() < 5)
    (True, True)
    """
    table = np.asarray(vertices)
    if table.shape != (68,) or table.dtype.kind not in "iu":
        raise ValueError(f"vertices: expected 68 whole numbers, got {table.dtype} of shape {table.shape}")
    if not 0 <= table.min() <= table.max() < len(model.mean):
        raise ValueError(f"vertices: expected vertices in 0..{len(model.mean) - 1}, got {table.min()} to {table.max()}")
    table = table.astype(np.int64)
    mean = model.mean if model.has("eyes") else model.mean - eye_origin(model.mean, table, 1.0)
    same = model.has("landmarks") and np.array_equal(model.landmarks[PARTS["jaw"]], table[PARTS["jaw"]])
    return replace(
        model,
        mean=mean,
        landmarks=table,
        contour_lines=model.contour_lines if same else (),
        regions={**named_parts(mean, table), **model.regions},
    )
