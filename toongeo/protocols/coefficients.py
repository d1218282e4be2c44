"""Coefficients of a face, and what guesses them."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo.protocols.cameras import HeadCamera

__all__ = ["Coefficients", "Regressor"]


@dataclass(frozen=True, eq=False)
class Coefficients:
    """What describes a face in a picture; any part may be None, that is, not known.

    Attributes
    ----------
    identity : (k,) float
        Standard deviations.
    expression : (e,) float
        Named expressions in [0, 1], the others in standard deviations.
    albedo : (a,) float
        Standard deviations.
    light : float array
        Spherical harmonics a channel.
    pose : HeadCamera
        From the model frame to the picture.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> known = tg.Coefficients(identity=np.zeros(81))  # what a regressor gives that knows the identity alone
    >>> known.identity.shape, known.expression is None
    ((81,), True)
    """

    identity: np.ndarray | None = None
    expression: np.ndarray | None = None
    albedo: np.ndarray | None = None
    light: np.ndarray | None = None
    pose: HeadCamera | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        for name in ("identity", "expression", "albedo", "light"):
            value = getattr(self, name)
            if value is None:
                continue
            array = np.array(value, np.float64)
            if not np.isfinite(array).all():
                raise ValueError(f"{name}: expected finite numbers or None, got NaN or infinity")
            array.setflags(write=False)
            object.__setattr__(self, name, array)


class Regressor(Protocol):
    """Guesses the coefficients of a face; a network, say, or any function.

    :func:`toongeo.testing.check_regressor` checks one; ``fit_3dmm(img, landmarks, regressor=...)`` uses it.

    Examples
    --------
    >>> from toongeo import default_model
    >>> from toongeo.testing import check_regressor
    >>> class Widest:
    ...     "The first mode of identity is how wide a face is."
    ...     def __call__(self, img, landmarks):
    ...         width, height = np.nanmax(landmarks, 0) - np.nanmin(landmarks, 0)
    ...         identity = np.zeros(len(default_model().identity))
    ...         identity[0] = np.clip(width / height - 1, -1, 1)
    ...         return Coefficients(identity=identity)
    >>> check_regressor(Widest(), picture=False)
    """

    def __call__(self, img: np.ndarray | None, landmarks: np.ndarray) -> Coefficients:
        """Coefficients of the face with landmarks (68, 2) px, NaN where missing.

        The picture is (H, W, 3) uint8, or None when there is none.
        """
        ...
