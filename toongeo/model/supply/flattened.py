"""Texture coordinates for a surface that has none."""

from __future__ import annotations

from dataclasses import replace

import igl
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.geometry.operators.adjacency import adjacency
from toongeo.geometry.operators.components import components
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.model.morphable_model import MorphableModel

__all__ = ["flattened", "with_uv"]

_MARGIN = 0.01  # of the atlas around each part, so that filtering does not bleed
_STRIP = 0.12  # of the atlas at the bottom, for all parts but the largest
_LEAST_BORDER = 3


def with_uv(model: MorphableModel) -> MorphableModel:
    """A model with texture coordinates from :func:`flattened`; one that has some keeps them.

    A closed surface has no border to lay down: for it longitude and latitude stand in, as for any model without
    coordinates (:func:`toongeo.model.atlas_coordinates`).

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> template = default_model()
    >>> front = template.faces[template.region("face")[template.faces].all(1)]
    >>> used, faces = np.unique(front, return_inverse=True)
    >>> mask = MorphableModel.from_arrays(template.mean[used], faces.reshape(-1, 3)).with_uv()
    >>> mask.has("uv"), bool(mask.uv.min() >= 0), bool(mask.uv.max() <= 1)
    (True, True, True)
    """
    if model.has("uv", "uv_faces"):
        return model
    uv = flattened(model.mean, model.faces)
    return model if uv is None else replace(model, uv=uv, uv_faces=model.faces)


def flattened(V: NDArray[np.float64], F: NDArray[np.int64]) -> NDArray[np.float64] | None:
    """One place (n, 2) in the unit square for each vertex of a surface with a border.

    Its longest border becomes a circle, the subject's left on the right of the picture, and the rest is laid into it by
    mean values of the neighbours (libigl's harmonic map where it turns no triangle over, and Tutte's, which never does,
    elsewhere); then vertices are spread by equal area of rings, since a face bulges. Other parts, such as eyeballs, lie
    in a strip below. None: the largest part is closed.

    References
    ----------
    W. T. Tutte, "How to draw a graph", 1963; M. Floater, "Parametrization and smooth approximation of surface
    triangulations", CAGD 1997.
    """
    number = components(F, len(V))
    sizes = np.bincount(number)
    order = np.argsort(-sizes, kind="stable")
    uv = np.zeros((len(V), 2))
    for rank, part in enumerate(order):
        rows = np.flatnonzero(number == part)
        if sizes[part] < _LEAST_BORDER:
            continue
        new = np.full(len(V), -1)
        new[rows] = np.arange(len(rows))
        faces = new[F[number[F[:, 0]] == part]]
        flat = _disc(V[rows], faces)
        if flat is None and rank == 0:
            return None
        if flat is None:
            flat = V[rows][:, :2]  # as seen from in front
        uv[rows] = _boxed(flat, rank, min(len(order), 9))
    return uv


def _disc(V: NDArray[np.float64], F: NDArray[np.int64]) -> NDArray[np.float64] | None:
    """Places (n, 2) in the unit disc; None for a closed surface."""
    border = np.asarray(igl.boundary_loop(F), np.int64)
    if len(border) < _LEAST_BORDER:
        return None
    low = border[np.argmin(V[border, 1])]
    border = np.roll(border, -int(np.flatnonzero(border == low)[0]))  # begins at the chin
    length = np.linalg.norm(V[np.roll(border, -1)] - V[border], axis=1)
    angle = 2 * np.pi * np.cumsum(np.r_[0, length[:-1]]) / length.sum() - np.pi / 2
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    flat = np.asarray(igl.harmonic(V, F, border, circle, 1))
    if not np.isfinite(flat).all() or (_areas(flat, F) * np.sign(_areas(flat, F).sum()) <= 0).any():
        flat = _tutte(F, border, circle, len(V))
    return flat


def _tutte(F: NDArray[np.int64], border: NDArray[np.int64], circle: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """Each inner vertex in the middle of its neighbours."""
    A = adjacency(F, n)
    L = sp.csr_array(sp.diags_array(np.maximum(np.asarray(A.sum(axis=1)).ravel(), 1)) - A)
    inner = np.setdiff1d(np.arange(n), border)
    flat = np.zeros((n, 2))
    flat[border] = circle
    if len(inner):
        flat[inner] = solve(factor_spd(L[inner][:, inner]), -(L[inner][:, border] @ circle))
    return flat


def _areas(uv: NDArray[np.float64], F: NDArray[np.int64]) -> NDArray[np.float64]:
    a, b = uv[F[:, 1]] - uv[F[:, 0]], uv[F[:, 2]] - uv[F[:, 0]]
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _boxed(flat: NDArray[np.float64], rank: int, parts: int) -> NDArray[np.float64]:
    """Into the large square of the largest part, or a small one in the strip below it."""
    low, size = flat.min(axis=0), np.ptp(flat, axis=0).max()
    unit = (flat - low) / (size if size > 0 else 1.0)
    if rank == 0:
        side = 1.0 - (_STRIP if parts > 1 else 0.0)
        corner = np.array([(1 - side) / 2, 1 - side])
    else:
        side = min(_STRIP, 1.0 / max(parts - 1, 1))
        corner = np.array([((rank - 1) % max(parts - 1, 1)) * side, 0.0])
    return np.asarray(corner + side * (_MARGIN + (1 - 2 * _MARGIN) * unit))
