"""Caricatures of the deformation space: identities extrapolated so that rotations turn on and nothing swells."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from renders.canvas import between
from renders.random_head import Head, finished_head, random_expression
from renders.template import template
from scipy.spatial import cKDTree

from toongeo.caricature.space.face_space import IDENTITIES, face_space

__all__ = ["exaggerated_head"]

_AMOUNT = 1.0, 2.6  # of a person's usual difference from the mean face; Wu et al. (2018) show faces of one to three
_MIXED = 3  # identities
_NEAREST = 8  # vertices of the skin that those within follow
_AROUND_EYE = 24.0  # mm from its centre: the lids and what holds them


def exaggerated_head(rng: np.random.Generator) -> Head:
    """A caricature (Wu et al. 2018, Eq. 5-8) with an expression; parts may be magnified besides."""
    model, space = template().model, face_space()
    w = np.zeros((2, len(space.space.rotations)))
    chosen, mix = rng.choice(IDENTITIES, _MIXED, replace=False), rng.normal(size=_MIXED)
    w[:, chosen] = mix / np.linalg.norm(mix) * between(rng, *_AMOUNT)
    w[1] *= between(rng, 0.7, 1.2)
    skin = space.space.vertices(w) - space.space.reference
    moves = np.empty_like(model.mean)
    moves[space.vertices] = skin
    inside, nearest, weights = _followers()
    moves[inside] = np.einsum("nk,nkc->nc", weights, skin[nearest])
    likely = np.where(np.arange(len(model.identity)) < model.prior.n_principal, model.prior.mean, 0)
    base = model.vertices(likely * between(rng, 0, 1), random_expression(rng, "caricature"))
    eyeballs = [_moved(*eye.placed(model.prior.mean * 0), model.mean[space.vertices], skin) for eye in model.eyes]
    return finished_head(rng, "caricature", base + moves, eyeballs)


def _moved(centre: NDArray[np.float64], radius: float, skin: NDArray[np.float64], moves: NDArray[np.float64]):
    """An eyeball that goes and grows with the skin around it."""
    near = np.linalg.norm(skin - centre, axis=1) < _AROUND_EYE
    before, after = skin[near], skin[near] + moves[near]
    growth = np.linalg.norm(after - after.mean(axis=0)) / np.linalg.norm(before - before.mean(axis=0))
    return centre + moves[near].mean(axis=0), radius * growth


@cache
def _followers() -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Vertices (k,) within the head, and for each the rows (k, 8) of the skin it follows, with weights."""
    space = face_space()
    mean = space.model.mean
    inside = np.setdiff1d(np.arange(len(mean)), space.vertices)
    distances, nearest = cKDTree(mean[space.vertices]).query(mean[inside], _NEAREST)
    weights = 1 / (distances + 1.0)
    return inside, nearest, weights / weights.sum(axis=1, keepdims=True)
