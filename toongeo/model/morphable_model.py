"""A linear morphable face model."""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from toongeo._read_only import read_only
from toongeo.geometry.one_thread import one_thread
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.face_prior import FacePrior

__all__ = ["MorphableModel"]


@dataclass(frozen=True, eq=False)
class MorphableModel:
    """Shape and albedo are linear in their coefficients (Pan et al. 2024, Eq. 1-2); the model holds no coefficients.

    Attributes
    ----------
    mean : (n, 3) float64, mm, model frame
    faces : (m, 3) int64, counter-clockwise from outside
    quads : (q, 4) int64
        The same surface in quads.
    identity : (k, n, 3) float32
        One unit of a coefficient is one standard deviation.
    expression : (e, n, 3) float32
        The named ones first; their natural range is [0, 1].
    expression_names : tuple of e names
    n_named : int
        How many expressions are named FACS units.
    albedo_mean : (n, 3) float32, sRGB in [0, 1]
    albedo : (a, n, 3) float32
    landmarks : (68,) int64
        Vertex of each iBUG-68 point, facing the camera.
    contour_lines : 17 arrays of vertices
        For jaw point k, the vertices on which it can lie, from the front to the back of the head.
    regions : name -> (n,) bool
    mirror : (n,) int64
        The vertex on the other side of the plane x = 0.
    uv : (t, 2) float64, origin bottom left
    uv_faces : (m, 3) int64
    eyes : left and right eyeball
        Empty for a model that has none; the rig needs them.
    prior : FacePrior or None
        None where the mean is the likeliest face and annotators see its landmarks where they are.
    """

    mean: np.ndarray
    faces: np.ndarray
    quads: np.ndarray
    identity: np.ndarray
    expression: np.ndarray
    expression_names: tuple[str, ...]
    n_named: int
    albedo_mean: np.ndarray
    albedo: np.ndarray
    landmarks: np.ndarray
    contour_lines: tuple[np.ndarray, ...]
    regions: Mapping[str, np.ndarray]
    mirror: np.ndarray
    uv: np.ndarray
    uv_faces: np.ndarray
    eyes: tuple[EyeballTemplate, ...] = ()
    prior: FacePrior | None = None

    def __post_init__(self) -> None:
        if self.prior is not None and self.prior.mean.shape != (len(self.identity),):
            expected = (len(self.identity),)
            raise ValueError(f"prior: expected a mean of shape {expected}, got {self.prior.mean.shape}")
        read_only(self, *(field.name for field in fields(self) if field.name not in ("eyes", "prior")))

    def vertices(self, identity: np.ndarray | None = None, expression: np.ndarray | None = None) -> np.ndarray:
        """Vertices (n, 3), mm, for identity (k,) and expression (e,) coefficients; None is zero.

        Raises
        ------
        ValueError
            If a coefficient vector has another length than the model has modes.
        """
        V = self.mean.copy()
        for name, coefficients, modes in (
            ("identity", identity, self.identity),
            ("expression", expression, self.expression),
        ):
            if coefficients is None:
                continue
            c = np.asarray(coefficients, float)
            if c.shape != (len(modes),):
                raise ValueError(f"{name}: expected shape ({len(modes)},), got {c.shape}")
            with one_thread():  # how BLAS splits a sum among threads would show in the last digits
                V += (c.astype(np.float32) @ modes.reshape(len(modes), -1)).reshape(-1, 3)
        return V

    def region(self, name: str) -> np.ndarray:
        """Mask (n,) of a named region; an unknown name raises ValueError that lists the known ones."""
        if name not in self.regions:
            raise ValueError(f"name: no region {name!r}; known: {', '.join(sorted(self.regions))}")
        return self.regions[name]

    def expression_index(self, name: str) -> int:
        """Index of a named expression; an unknown name raises ValueError that suggests the nearest ones."""
        if name in self.expression_names:
            return self.expression_names.index(name)
        near = difflib.get_close_matches(name, self.expression_names, n=3, cutoff=0.4)
        hint = f"; did you mean {', '.join(near)}?" if near else ""
        raise ValueError(f"name: no expression {name!r}{hint}")
