"""The head that ships with the library."""

from functools import cache

import numpy as np

from toongeo.model.artist_model import MoreModes, artist_model
from toongeo.model.data_path import data_path
from toongeo.model.face_prior import FacePrior
from toongeo.model.morphable_model import MorphableModel

__all__ = ["default_model"]


@cache
def default_model() -> MorphableModel:
    """The default template: a head of about 19,000 vertices, 81 identity and 64 expression modes.

    The shapes are an artist's (CC0), how they vary is that of people: the first 80 identity modes are the principal
    axes of faces registered to it, the largest first, in standard deviations. The last one leads from the likeliest
    face that these can make to the mean of people, which they do not span. The mean of the model is the artist's; the
    likeliest face is ``default_model().prior.mean``. Loaded once a process; read-only.

    Returns
    -------
    MorphableModel

    Examples
    --------
    >>> model = default_model()
    >>> model.identity.shape[0], model.expression.shape[0], model.n_named, model.landmarks.shape
    (81, 64, 46, (68,))
    """
    with np.load(data_path("data_templates/prior.npz"), allow_pickle=False) as archive:
        z = {name: archive[name] for name in archive.files}
    more = MoreModes(
        cage=z["mean_mode"][None],
        eye_centres=z["mean_mode_eyes"][:, None],
        eye_radii=np.full((2, 1), z["mean_mode_radius"]),
    )
    prior = FacePrior(
        n_principal=len(z["mean"]),
        mean=np.append(z["mean"], z["mean_mode_share"]).astype(np.float64),
        **{name: z[name].astype(np.float64) for name in ("landmark_offsets", "landmark_covariance", "scan_offsets")},
    )
    return artist_model(z["axes"].astype(np.float64), more, prior)
