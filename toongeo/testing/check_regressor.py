"""Whether something is a `Regressor`."""

from __future__ import annotations

import numpy as np

from toongeo.model import MorphableModel, default_model
from toongeo.protocols import Coefficients, Regressor
from toongeo.testing.example import example, require, unchanged

__all__ = ["check_regressor"]


def check_regressor(regressor: Regressor, *, model: MorphableModel | None = None, picture: bool = True) -> None:
    """Call a regressor as the fit does, and look at what it gives.

    Parameters
    ----------
    regressor : Regressor
    model : MorphableModel, optional
        Whose coefficients it guesses; :func:`toongeo.default_model` unless given.
    picture : bool
        Whether it needs one; without, it is also called with None in its place.

    Raises
    ------
    AssertionError
        If it returns something else than coefficients of the model, other ones the second time, fails where
        landmarks are missing, or writes to its arguments.

    Examples
    --------
    >>> check_regressor(lambda img, landmarks: Coefficients(identity=np.zeros(80)))
    """
    model = model or default_model()
    img, points = (np.array(part) for part in example())
    holes = points.copy()
    holes[[3, 20, 61]] = np.nan
    calls = [(img, points), (img, holes), *([] if picture else [(None, points)])]
    for given, landmarks in calls:
        before = landmarks.copy(), None if given is None else given.copy()
        found, again = regressor(given, landmarks), regressor(given, landmarks)
        require(isinstance(found, Coefficients), f"regressor: expected Coefficients, got {type(found).__name__}")
        for name, size in (
            ("identity", len(model.identity)),
            ("expression", len(model.expression)),
            ("albedo", len(model.albedo)),
        ):
            value, other = getattr(found, name), getattr(again, name)
            if value is not None:
                require(value.shape == (size,), f"{name}: expected shape ({size},) of this model, got {value.shape}")
                require(np.array_equal(value, other), f"{name}: expected the same a second time")
        unchanged("landmarks", before[0], landmarks)
        if given is not None and before[1] is not None:
            unchanged("img", before[1], given)
