"""A linear morphable face model."""

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo._read_only import read_only, restored
from toongeo.geometry.one_thread import one_thread
from toongeo.model.anatomy.parts import INNER_PARTS
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.face_prior import FacePrior
from toongeo.model.ibug68 import PARTS
from toongeo.model.mirrored_vertices import mirrored_vertices
from toongeo.model.regions import REGIONS

__all__ = ["MorphableModel"]

_GREY = 0.6  # sRGB of a model without colours: of the lightness of skin, without its hue

__all__ = ["MorphableModel"]


def _nothing() -> np.ndarray:
    return np.zeros(0)


@dataclass(frozen=True, eq=False, kw_only=True)
class MorphableModel:
    """Shape and albedo are linear in their coefficients (Pan et al. 2024, Eq. 1-2); the model holds no coefficients.

    A mean face, its triangles, how people differ from it, and the vertices of the landmarks are needed; the rest a
    model may have or not. Stages ask for what they need by :meth:`has` and do without what is missing: that a model
    of bare skin gives an avatar without eyeballs, teeth and expressions is no error.

    Attributes
    ----------
    mean : (n, 3) float64, mm, model frame
    faces : (m, 3) int64, counter-clockwise from outside
    identity : (k, n, 3) float32
        One unit of a coefficient is one standard deviation.
    landmarks : (68,) int64
        Vertex of each iBUG-68 point, facing the camera.
    quads : (q, 4) int64
        The same surface in quads; none: the model is known by its triangles alone.
    expression : (e, n, 3) float32
        The named ones first; their natural range is [0, 1]. None: a rig of this model has no expressions.
    expression_names : tuple of e names
    n_named : int
        How many expressions are named FACS units.
    albedo_mean : (n, 3) float32, sRGB in [0, 1]
        Grey unless it is given.
    albedo : (a, n, 3) float32
    contour_lines : 17 arrays of vertices
        For jaw point k, the vertices on which it can lie, from the front to the back of the head. Unless they are
        given a jaw point does not slide.
    regions : name -> (n,) bool
    mirror : (n,) int64
        The vertex on the other side of the plane x = 0; unless it is given, the one nearest to there.
    uv : (t, 2) float64, origin bottom left
        None: longitude and latitude stand in (:func:`toongeo.model.atlas_coordinates`).
    uv_faces : (m, 3) int64
    eyes : left and right eyeball, or none
    prior : FacePrior or None
        None where the mean is the likeliest face and annotators see its landmarks where they are.

    Raises
    ------
    ValueError
        If the mean of the prior has another length than there are identity modes, or a landmark is no vertex.
    """

    mean: np.ndarray
    faces: np.ndarray
    identity: np.ndarray
    landmarks: np.ndarray
    quads: np.ndarray = field(default_factory=_nothing)
    expression: np.ndarray = field(default_factory=_nothing)
    expression_names: tuple[str, ...] = ()
    n_named: int = 0
    albedo_mean: np.ndarray = field(default_factory=_nothing)
    albedo: np.ndarray = field(default_factory=_nothing)
    contour_lines: tuple[np.ndarray, ...] = ()
    regions: Mapping[str, np.ndarray] = field(default_factory=dict)
    mirror: np.ndarray = field(default_factory=_nothing)
    uv: np.ndarray = field(default_factory=_nothing)
    uv_faces: np.ndarray = field(default_factory=_nothing)
    eyes: tuple[EyeballTemplate, ...] = ()
    prior: FacePrior | None = None

    __repr__ = brief_repr
    _repr_png_ = notebook_png
    __setstate__ = restored

    def __post_init__(self) -> None:
        if self.prior is not None and self.prior.mean.shape != (len(self.identity),):
            expected = (len(self.identity),)
            raise ValueError(f"prior: expected a mean of shape {expected}, got {self.prior.mean.shape}")
        if self.landmarks.size and not 0 <= self.landmarks.min() <= self.landmarks.max() < len(self.mean):
            got = f"{self.landmarks.min()} to {self.landmarks.max()}"
            raise ValueError(f"landmarks: expected vertices in 0..{len(self.mean) - 1}, got {got}")
        for name, value in self._stand_ins().items():
            object.__setattr__(self, name, value)
        read_only(self, *(part.name for part in fields(self) if part.name not in ("eyes", "prior")))

    def _stand_ins(self) -> dict[str, Any]:
        """What takes the place of fields that were not given."""
        n = len(self.mean)
        empty: dict[str, np.ndarray] = {
            "expression": np.zeros((0, n, 3), np.float32),
            "albedo": np.zeros((0, n, 3), np.float32),
            "quads": np.zeros((0, 4), np.int64),
            "uv": np.zeros((0, 2)),
            "uv_faces": np.zeros((0, 3), np.int64),
        }
        values: dict[str, Any] = {name: array for name, array in empty.items() if not getattr(self, name).size}
        if not self.albedo_mean.size:
            values["albedo_mean"] = np.full((n, 3), _GREY, np.float32)
        if not self.contour_lines:
            values["contour_lines"] = tuple(self.landmarks[k : k + 1] for k in PARTS["jaw"])
        if not self.mirror.size:
            values["mirror"] = mirrored_vertices(self.mean)
        return values

    def has(self, *names: str) -> bool:
        """Whether the model has all of some parts.

        Parameters
        ----------
        *names
            Regions, named expressions, or what a model need not bring along: ``"quads"``, ``"uv"``, ``"uv_faces"``,
            ``"eyes"``, ``"albedo"``, ``"expression"`` (at least one that is named).

        Examples
        --------
        >>> from toongeo.model import default_model
        >>> default_model().has("eyes", "teeth_upper", "jawOpen"), default_model().has("beard")
        (True, False)
        """
        return all(self._has(name) for name in names)

    def _has(self, name: str) -> bool:
        if name == "expression":
            return self.n_named > 0
        if name in ("quads", "uv", "uv_faces", "eyes", "albedo"):
            return len(getattr(self, name)) > 0
        return name in self.expression_names[: self.n_named] or (
            name in self.regions and bool(self.regions[name].any())
        )

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
                V += (c.astype(np.float32) @ modes.reshape(len(modes), V.size)).reshape(-1, 3)
        return V

    def region(self, name: str) -> np.ndarray:
        """Mask (n,) of a named region.

        In a model that does not tell what is ``skin`` that is all but the neck and what it says lies behind the skin;
        without a ``face`` that is its skin. Another region of the table ``data_templates/regions.csv`` that the model
        does not have is empty.

        Raises
        ------
        ValueError
            If neither the model nor the table knows the name; lists the known ones.
        """
        if name in self.regions:
            return self.regions[name]
        if name == "face":
            return self.region("skin")
        if name not in REGIONS:
            known = sorted({*REGIONS, *self.regions})
            raise ValueError(f"name: no region {name!r}; known: {', '.join(known)}")
        mask = np.full(len(self.mean), name == "skin")
        if name == "skin":
            for other in ("neck", *INNER_PARTS):
                mask &= ~self.region(other)
        return mask

    def expression_index(self, name: str) -> int:
        """Index of a named expression; an unknown name raises ValueError that suggests the nearest ones."""
        if name in self.expression_names:
            return self.expression_names.index(name)
        near = difflib.get_close_matches(name, self.expression_names, n=3, cutoff=0.4)
        hint = f"; did you mean {', '.join(near)}?" if near else ""
        raise ValueError(f"name: no expression {name!r}{hint}")
