"""The head that ships with the library."""

from dataclasses import replace
from functools import cache

import numpy as np

from toongeo.model.artist_model import artist_model
from toongeo.model.data_path import data_path
from toongeo.model.face_prior import FacePrior
from toongeo.model.morphable_model import MorphableModel

__all__ = ["default_model"]


@cache
def default_model() -> MorphableModel:
    """The default template: a head of about 19,000 vertices, 80 identity and 64 expression modes.

    The shapes are an artist's (CC0), how they vary is that of people: the identity modes are the principal axes of
    faces registered to it, the largest first, in standard deviations. Its mean is the artist's; the mean of the people
    is ``default_model().prior.mean``. Loaded once a process; read-only.

    Examples
    --------
    >>> model = default_model()
    >>> model.identity.shape[0], model.expression.shape[0], model.n_named, model.landmarks.shape
    (80, 64, 46, (68,))
    """
    with np.load(data_path("data_templates/prior.npz"), allow_pickle=False) as archive:
        z = {name: archive[name].astype(np.float64) for name in archive.files}
    return replace(artist_model(z.pop("axes")), prior=FacePrior(**z))
