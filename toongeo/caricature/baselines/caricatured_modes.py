"""A morphable model of caricatured faces (Wu et al. 2018, section 5.2)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from toongeo.caricature.caricature_surface import caricature_surface
from toongeo.geometry.one_thread import one_thread
from toongeo.model.morphable_model import MorphableModel

__all__ = ["caricatured_modes"]


def caricatured_modes(
    model: MorphableModel,
    rng: np.random.Generator,
    *,
    identities: int = 40,
    gammas: Sequence[float] = (0.0, 0.15, 0.3),
    count: int = 80,
) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Principal components of random identities, each as it is and as `caricature_surface` makes it.

    Parameters
    ----------
    model : MorphableModel
    rng : Generator
        Draws the identities.
    identities : int
        How many, each at every gamma.
    gammas : floats
        0 is the face itself.
    count : int
        Components kept, at most one less than there are shapes.

    Returns
    -------
    mean : (n, 3) float64, mm
    modes : (c + e, n, 3) float32
        Components of one standard deviation, then the expressions of the model.
    """
    drawn = rng.standard_normal((identities, len(model.principal_modes)))
    rest = np.zeros(len(model.identity) - drawn.shape[1])
    faces = [model.vertices(np.append(a, rest)) for a in drawn]
    shapes = np.stack([caricature_surface(V, model.faces, gamma) for V in faces for gamma in gammas])
    mean = shapes.mean(axis=0)
    X = (shapes - mean).reshape(len(shapes), -1)
    with one_thread():
        values, vectors = np.linalg.eigh(X @ X.T)
        kept = np.flatnonzero(values > 1e-9 * values[-1])[::-1][:count]
        # One unit of a component is its standard deviation: X^T v has the length sqrt(value).
        components = (vectors[:, kept].T @ X) / np.sqrt(len(shapes))
    modes = components.reshape(len(kept), -1, 3).astype(np.float32)
    return mean, np.concatenate([modes, model.expression])
