"""GNM Head."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise
from toongeo.reading.read_npz import npz_names, read_npz

__all__ = ["is_gnm", "load_gnm"]

_METRES = 1000.0  # mm
_KEYS = ("template_vertex_positions", "vertex_identity_basis", "expression_basis", "triangles")
_MORE = ("quads", "triangle_uvs", "expression_names", "mirror_indices", "vertex_groups", "vertex_group_names")
_INSIDE = 0.5  # weight of a group from which on a vertex belongs to it
_REGIONS = {  # names of groups, those of earlier files as well
    "skin": "skin",
    "ears": "ears",
    "tongue": "tongue",
    "upper_teeth_and_gums": "teeth_upper",
    "upper_teeth": "teeth_upper",
    "lower_teeth_and_gums": "teeth_lower",
    "lower_teeth": "teeth_lower",
}


def is_gnm(path: Path) -> bool:
    """Whether an archive is GNM."""
    return set(_KEYS) <= set(npz_names(path))


def load_gnm(path: str | Path, landmarks: NDArray[np.int64] | None = None) -> MorphableModel:
    """``gnm_head.npz``: metres become mm, bases are in standard deviations already; expressions are no FACS units.

    Quads, texture coordinates, mirrored vertices and groups are taken over. Its 68 landmarks are a file of their own
    (``indices`` and ``weights``, (68, 3) each): ``load_model(path, landmarks=...)``.

    Parameters
    ----------
    path : str or Path
    landmarks : (68,) int, optional

    Raises
    ------
    ValueError
        If arrays are missing, sizes do not fit, numbers are not finite or indices out of range.

    References
    ----------
    "GNM Head: a generative anthropometric model of the human head", 2026.
    """
    path = Path(path)
    z = read_npz(path, _KEYS, _MORE, expected="GNM")
    with promise(path, "GNM", alone=True):
        names = [str(name) for name in z.get("expression_names", ())]
        quads = z.get("quads")
        return MorphableModel.from_arrays(
            z["template_vertex_positions"],
            z["triangles"],
            identity=z["vertex_identity_basis"],
            expression=z["expression_basis"],
            expression_names=names,
            n_named=0,
            landmarks=landmarks,
            unit=_METRES,
            quads=quads if quads is not None and quads.shape[1:] == (4,) else None,
            mirror=z.get("mirror_indices"),
            regions=_regions(z),
            **_uv(z.get("triangle_uvs")),
        )


def _regions(z: dict[str, NDArray]) -> dict[str, NDArray[np.bool_]]:
    regions: dict[str, NDArray[np.bool_]] = {}
    for name, weights in zip(z.get("vertex_group_names", ()), z.get("vertex_groups", ()), strict=False):
        if str(name) in _REGIONS:
            regions[_REGIONS[str(name)]] = np.asarray(weights) > _INSIDE
    return regions


def _uv(corners: NDArray | None) -> dict[str, NDArray]:
    """Texture coordinates and their triangles, of coordinates (m, 3, 2) a corner."""
    if corners is None or corners.ndim != 3 or corners.shape[1:] != (3, 2):
        return {}
    uv, uv_faces = np.unique(corners.reshape(-1, 2), axis=0, return_inverse=True)
    return {"uv": uv.astype(np.float64), "uv_faces": uv_faces.reshape(-1, 3).astype(np.int64)}
