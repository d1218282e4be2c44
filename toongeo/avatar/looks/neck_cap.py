"""What closes a neck at its lower end."""

from __future__ import annotations

import numpy as np

from toongeo.model import MorphableModel, atlas_coordinates
from toongeo.model.anatomy.neck import neck_rim
from toongeo.pipeline import Rig
from toongeo.render import Surface, sample_image, uv_to_px

__all__ = ["neck_cap"]


def neck_cap(model: MorphableModel, rig: Rig, texture: np.ndarray) -> Surface | None:
    """A fan of triangles over the hole at the lower end of the neck, in the mean colour of its rim.

    Its first vertices are those of the rim, which no expression moves; the last one is their mean.

    Returns
    -------
    Surface or None
        None of a model without a region ``neck`` in which there is such a hole.
    """
    rim = neck_rim(model)
    if rim is None:
        return None
    atlas = atlas_coordinates(model)
    points = rig.neutral[rim]
    on_rim = np.isin(model.faces, rim)
    uv = atlas.uv[np.unique(atlas.uv_faces[on_rim])]
    colour = np.asarray(sample_image(texture, uv_to_px(uv, *texture.shape[:2]))).mean(axis=0) / 255
    following = np.roll(np.arange(len(rim)), -1)
    faces = np.column_stack([following, np.arange(len(rim)), np.full(len(rim), len(rim))])
    return Surface(
        np.vstack([points, points.mean(axis=0)]), faces.astype(np.int64), colours=np.tile(colour, (len(rim) + 1, 1))
    )
