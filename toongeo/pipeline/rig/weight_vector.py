"""Expression weights as a checked vector."""

import difflib
import numbers
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["weight_vector"]

_LARGEST = 1e6  # shapes of 0.1 m then still fit float32, with room for sums of them


def weight_vector(weights: Mapping[str, float] | ArrayLike | None, names: Sequence[str]) -> np.ndarray:
    """Weights by name, or already a vector, as a vector in the order of ``names``.

    Parameters
    ----------
    weights : mapping of name to weight, (k,) array, or None
        None and names that are left out mean 0.
    names : sequence of k names

    Returns
    -------
    (k,) float64

    Raises
    ------
    ValueError
        If a name is unknown (the nearest ones are suggested), a vector has another length, or a weight is not finite
        or beyond a million.

    Examples
    --------
    >>> weight_vector({"jawOpen": 0.5}, ["eyeBlinkLeft", "jawOpen"])
    array([0. , 0.5])
    """
    if weights is None:
        return np.zeros(len(names))
    if isinstance(weights, Mapping):
        beta = np.zeros(len(names))
        for name, weight in weights.items():
            if name not in names:
                near = difflib.get_close_matches(str(name), names, n=3, cutoff=0.4)
                hint = f"; did you mean {', '.join(near)}?" if near else ""
                raise ValueError(f"weights: no expression {name!r}{hint}")
            if not isinstance(weight, numbers.Real):
                raise ValueError(f"weights: expected a number for {name}, got {weight!r}")
            beta[names.index(name)] = _number(weight, name)
    else:
        try:
            beta = np.asarray(weights, float)
        except (TypeError, ValueError, OverflowError) as error:
            raise ValueError(f"weights: expected a mapping of names, or {len(names)} numbers ({error})") from None
        if beta.shape != (len(names),):
            raise ValueError(f"weights: expected {len(names)} values, got shape {beta.shape}")
    if not np.isfinite(beta).all():
        raise ValueError("weights: expected finite values, got NaN or infinity")
    if (most := np.abs(beta).max(initial=0.0)) > _LARGEST:
        raise ValueError(f"weights: expected values up to {_LARGEST:g}, got {most:g}")
    return beta


def _number(weight: numbers.Real, name: str) -> float:
    try:
        return float(weight)
    except OverflowError:
        raise ValueError(f"weights: expected a number for {name}, got one beyond all floats") from None
