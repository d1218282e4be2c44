"""The head that ships with the library, as its artists made it."""

import csv
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from toongeo.geometry import catmull_clark
from toongeo.geometry.one_thread import one_thread
from toongeo.model.data_path import data_path
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.face_prior import FacePrior
from toongeo.model.morphable_model import MorphableModel

__all__ = ["MoreModes", "artist_model", "recombined"]

_AT_ONCE = 4  # modes that are turned from columns into rows while they are in the cache


@dataclass(frozen=True, eq=False)
class MoreModes:
    """Identity modes beside those of the artist.

    Attributes
    ----------
    cage : (c, n0, 3) float16, mm
        On the control cage.
    eye_centres : (2, c, 3) float32, mm
        Left and right eyeball.
    eye_radii : (2, c) float32, mm
    """

    cage: np.ndarray
    eye_centres: np.ndarray
    eye_radii: np.ndarray


def artist_model(
    axes: np.ndarray | None = None, more: MoreModes | None = None, prior: FacePrior | None = None
) -> MorphableModel:
    """The template as an artist made it: her choice of 80 identity modes, and of how far faces differ.

    Its modes are stored on a control cage and refined by one Catmull-Clark step when it is loaded; since the step is
    linear, the refined modes of the cage are the modes of the refined mesh.

    Parameters
    ----------
    axes : (80, c) float, optional
        Coefficients of other identity modes in those of the artist; these take their place.
    more : MoreModes, optional
        Modes that follow them.
    prior : FacePrior, optional

    Examples
    --------
    >>> doubled = artist_model(2 * np.eye(80))
    >>> bool(np.allclose(doubled.identity, 2 * artist_model().identity, atol=1e-5))
    True
    """
    with np.load(data_path("data_templates/head.npz"), allow_pickle=False) as archive:
        z = {name: archive[name] for name in archive.files}
    if axes is not None:
        z["identity"] = recombined(z["identity"], axes)
        for name in ("eye_centre_modes", "eye_radius_modes"):
            z[name] = np.stack([recombined(eye, axes) for eye in z[name]])
    if more is not None:
        z["identity"] = np.concatenate([z["identity"], more.cage])
        z["eye_centre_modes"] = np.concatenate([z["eye_centre_modes"], more.eye_centres], axis=1)
        z["eye_radius_modes"] = np.concatenate([z["eye_radius_modes"], more.eye_radii], axis=1)
    S, quads = catmull_clark(z["quads"].astype(np.int64), len(z["mean"]))
    uv, uv_quads = _refined_uv(z["uv"].astype(float), z["uv_quads"].astype(np.int64))
    named = [row["name"] for row in _table("expressions.csv")]
    extra = [f"extra{i + 1:02d}" for i in range(len(z["expression"]) - len(named))]
    bits = np.unpackbits(z["region_bits"], axis=1, count=S.shape[0]).astype(bool)
    return MorphableModel(
        mean=S @ z["mean"].astype(float),
        faces=_triangles(quads, z["diagonal"]),
        quads=quads,
        identity=_refined_modes(S, z["identity"]),
        expression=_refined_modes(S, z["expression"]),
        expression_names=(*named, *extra),
        n_named=len(named),
        albedo_mean=z["albedo_mean"].astype(np.float32),
        albedo=z["albedo"].astype(np.float32),
        landmarks=np.array([int(row["vertex"]) for row in _table("landmarks.csv")]),
        contour_lines=tuple(np.array(row["vertices"].split(), int) for row in _table("contours.csv")),
        regions={row["name"]: mask for row, mask in zip(_table("regions.csv"), bits, strict=True)},
        mirror=z["mirror"].astype(np.int64),
        uv=uv,
        uv_faces=_triangles(uv_quads, z["diagonal"]),
        eyes=(_eye(z, 0), _eye(z, 1)),
        prior=prior,
    )


def _table(name: str) -> list[dict[str, str]]:
    """Rows of a commented CSV table; its first line that is no comment is the header."""
    with open(data_path(f"data_templates/{name}"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def recombined(modes: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Modes (c, ...) float16 along axes (80, c) of modes (80, ...).

    Refining numbers of so few digits is exact, so mirrored vertices mirror each other to the last bit.
    """
    with one_thread():
        sums = axes.T.astype(np.float64) @ modes.reshape(len(axes), -1).astype(np.float64)
    return sums.reshape(-1, *modes.shape[1:]).astype(np.float16)


def _refined_modes(S: sp.csr_array, modes: np.ndarray) -> np.ndarray:
    """Modes (k, n0, 3) of the cage -> modes (k, n1, 3) float32 of the refined mesh."""
    S, refined = S.astype(np.float32), np.empty((len(modes), S.shape[0], 3), np.float32)
    for first in range(0, len(modes), _AT_ONCE):
        some = modes[first : first + _AT_ONCE]
        columns = some.transpose(1, 0, 2).reshape(modes.shape[1], -1).astype(np.float32)
        refined[first : first + _AT_ONCE] = (S @ columns).reshape(S.shape[0], len(some), 3).transpose(1, 0, 2)
    return refined


def _refined_uv(uv: np.ndarray, quads: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Texture coordinates split linearly (edge midpoints, quad means), so that islands keep their outlines."""
    edges = np.sort(np.stack([quads, np.roll(quads, -1, 1)], 2).reshape(-1, 2), 1)
    unique, inverse = np.unique(edges[:, 0] * len(uv) + edges[:, 1], return_inverse=True)
    ends = np.stack(np.divmod(unique, len(uv)), 1)
    points = np.vstack([uv, uv[ends].mean(1), uv[quads].mean(1)])
    edge = len(uv) + inverse.reshape(-1, 4)
    centre = len(uv) + len(unique) + np.arange(len(quads))
    children = [np.stack([quads[:, c], edge[:, c], centre, edge[:, c - 1]], 1) for c in range(4)]
    return points, np.stack(children, 1).reshape(-1, 4)


def _triangles(quads: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
    """Two triangles a quad, split along corners 0-2 where ``diagonal`` is true and along 1-3 elsewhere."""
    split = diagonal[:, None]
    first = np.where(split, quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    second = np.where(split, quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.ascontiguousarray(np.vstack([first, second]), np.int64)


def _eye(z: dict[str, np.ndarray], side: int) -> EyeballTemplate:
    return EyeballTemplate(
        centre=z["eye_centre"][side].astype(float),
        radius=float(z["eye_radius"][side]),
        centre_modes=z["eye_centre_modes"][side].astype(np.float32),
        radius_modes=z["eye_radius_modes"][side].astype(np.float32),
        vertices=z["eye_vertices"].astype(float),
        faces=z["eye_faces"].astype(np.int64),
        uv=z["eye_uv"][side].astype(float),
        colour=z["eye_colour"].astype(np.float32),
        iris_angle=float(z["iris_angle"]),
        pupil_angle=float(z["pupil_angle"]),
    )
