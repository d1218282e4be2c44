"""Identity modes: principal components of random faces, symmetric and antisymmetric parts apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from cage import Cage
from source import Floats

# Millimetres a decimetre of the source: slightly more than life size gives a pupil distance of 60 mm.
MILLIMETRES = 105.0
N_MODES = 80


@dataclass(frozen=True, eq=False)
class Identity:
    """Mean (n, 3) mm in the model frame, exactly symmetric, and modes (80, n, 3) mm a standard deviation, by
    descending variance; `symmetric` (80,) tells the modes that keep the symmetry."""

    mean: Floats
    modes: Floats
    symmetric: np.ndarray


def aligned(faces: Floats, cage: Cage, start: Floats, weight: Floats) -> tuple[Floats, Floats]:
    """Generalized Procrustes alignment (similarities) of `faces` (k, n, 3) by the vertices of positive
    `weight` (n,); returns aligned faces and their symmetric mean, both in model-frame millimetres."""
    mean = start
    for _ in range(4):
        faces = _procrustes(faces, mean, weight)
        centre = faces.mean(0)
        mean = _procrustes(((centre + cage.mirrored(centre)) / 2)[None], mean, weight)[0]
    pupils = np.array([mean[cage.vertices_of(e)].mean(0) for e in ("eye_left", "eye_right")])
    origin = pupils.mean(0) * [0, 1, 1]
    return (faces - origin) * MILLIMETRES, (mean - origin) * MILLIMETRES


def _procrustes(faces: Floats, to: Floats, weight: Floats) -> Floats:
    """Similarity that brings each face closest to the shape `to`."""
    w = weight / weight.sum()
    at, bt = np.einsum("n,knc->kc", w, faces), w @ to
    a, b = faces - at[:, None], to - bt
    u, s, vt = np.linalg.svd(np.einsum("n,knc,nd->kcd", w, a, b))
    s[:, 2] *= np.sign(np.linalg.det(u @ vt))
    vt[:, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
    scale = s.sum(1) / np.einsum("n,knc->k", w, a**2)
    return scale[:, None, None] * (a @ (u @ vt)) + bt


def identity_space(faces: Floats, mean: Floats, cage: Cage, weight: Floats) -> Identity:
    """Principal modes of aligned `faces` (k, n, 3) under vertex weights (n,); the covariance of the faces and
    their mirror images commutes with the mirror, so its modes are symmetric or antisymmetric: both families
    are found apart."""
    delta = faces - mean
    mirrored = cage.mirrored(delta)
    root = np.sqrt(weight)[:, None]
    variances, modes, symmetric = [], [], []
    for part, is_symmetric in (((delta + mirrored) / 2, True), ((delta - mirrored) / 2, False)):
        flat = (part * root).reshape(len(part), -1)
        values, vectors = np.linalg.eigh(flat @ flat.T / len(part))
        for k in range(1, N_MODES + 1):
            mode = np.tensordot(vectors[:, -k], part, 1) / np.sqrt(len(part))
            variances.append(values[-k])
            modes.append(mode * np.sign(mode.ravel()[np.abs(mode).argmax()]))
            symmetric.append(is_symmetric)
    order = np.argsort(-np.array(variances), kind="stable")[:N_MODES]
    return Identity(mean, np.array(modes)[order], np.array(symmetric)[order])
