"""Which triangles of a head an export keeps."""

from typing import Literal, get_args

import numpy as np

from toongeo.model import MorphableModel
from toongeo.model.anatomy.parts import INNER_PARTS

__all__ = ["Crop", "crop_faces"]

Crop = Literal["head", "bust", "face"]


def crop_faces(model: MorphableModel, crop: Crop) -> np.ndarray:
    """Rows of ``model.faces`` (k,) that belong to a crop.

    Parameters
    ----------
    model : MorphableModel
    crop : {"head", "bust", "face"}
        "head" and "bust" keep all that the template has, neck included, which in the template that ships is the
        same; "face" keeps the front of the face with what lies in mouth and sockets, cut along whole quads.

    Raises
    ------
    ValueError
        If the crop is unknown.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> len(crop_faces(default_model(), "head")), len(crop_faces(default_model(), "face")) < 30_000
    (37568, True)
    """
    if crop not in get_args(Crop):
        raise ValueError(f"crop: expected one of {', '.join(get_args(Crop))}, got {crop!r}")
    if crop != "face":
        return np.arange(len(model.faces))
    inner = [model.region(name) for name in INNER_PARTS]
    kept = np.any([model.region("face"), *inner], axis=0)
    quads = len(model.faces) // 2
    whole = kept[model.faces].all(1)
    if 2 * quads == len(model.faces) == 2 * len(model.quads):  # both halves of a quad or none: no saw teeth
        whole = np.tile(whole[:quads] & whole[quads:], 2)
    return np.flatnonzero(whole)
