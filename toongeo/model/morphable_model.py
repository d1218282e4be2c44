"""A linear morphable face model."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo._read_only import read_only, restored
from toongeo.geometry.one_thread import one_thread
from toongeo.model.anatomy.parts import INNER_PARTS
from toongeo.model.check_model import check_model
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.face_prior import FacePrior
from toongeo.model.regions import REGIONS
from toongeo.model.supply.skinning import Skinning
from toongeo.model.supply.stand_ins import has_part, stand_ins

_OBJECTS = ("eyes", "skinning", "prior")  # look after their own arrays

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
    landmarks : (68,) int64, or (0,)
        Vertex of each iBUG-68 point, facing the camera. A model without is given them by :meth:`with_landmarks`.
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
    skinning : Skinning or None
        Joints of the jaw and neck, in models that turn them: :meth:`posed`.
    prior : FacePrior or None
        None where the mean is the likeliest face and annotators see its landmarks where they are.

    Raises
    ------
    ValueError
        If the mean of the prior has another length than there are identity modes, an array has another shape than it
        should, numbers that are not finite or indices out of range, or the sizes of two do not fit together.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> model = tg.default_model()
    >>> model.mean.shape, model.identity.shape, model.n_named
    ((19057, 3), (81, 19057, 3), 46)
    >>> face = model.vertices(np.eye(81)[0], np.eye(64)[model.expression_index("jawOpen")])  # (n, 3) mm
    >>> float(np.linalg.norm(face - model.mean, axis=1).max()) > 5  # mm
    True
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
    skinning: Skinning | None = None
    prior: FacePrior | None = None

    __repr__ = brief_repr
    _repr_png_ = notebook_png
    __setstate__ = restored

    def __post_init__(self) -> None:
        if self.prior is not None and self.prior.mean.shape != (len(self.identity),):
            expected = (len(self.identity),)
            raise ValueError(f"prior: expected a mean of shape {expected}, got {self.prior.mean.shape}")
        check_model(self)
        for name, value in stand_ins(self).items():
            object.__setattr__(self, name, value)
        read_only(self, *(part.name for part in fields(self) if part.name not in _OBJECTS))

    def has(self, *names: str) -> bool:
        """Whether the model has all of some parts.

        Parameters
        ----------
        *names
            Regions, named expressions, or what a model need not bring along: ``"landmarks"``, ``"quads"``,
            ``"uv"``, ``"uv_faces"``, ``"eyes"``, ``"albedo"``, ``"contours"`` (along which jaw points slide),
            ``"skinning"``, ``"expression"`` (at least one that is named).

        Examples
        --------
        >>> from toongeo.model import default_model
        >>> default_model().has("eyes", "teeth_upper", "jawOpen"), default_model().has("beard")
        (True, False)
        """
        return all(has_part(self, name) for name in names)

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

    def posed(
        self,
        identity: np.ndarray | None = None,
        expression: np.ndarray | None = None,
        *,
        pose: Mapping[str, ArrayLike],
    ) -> np.ndarray:
        """Vertices (n, 3), mm, with joints turned: ``pose={"jaw": (0.2, 0, 0)}``, rotation vectors in radians.

        Raises
        ------
        ValueError
            If the model has no such joint, or none at all.
        """
        if self.skinning is None:
            raise ValueError("model: expected one with joints, got one whose expressions are all linear")
        return self.skinning.posed(self.vertices(identity, expression), pose)

    @property
    def principal_modes(self) -> np.ndarray:
        """Identity modes (c, n, 3), mm, of unit variance between people: random faces are drawn from them.

        A mode that leads from a mean that they can make to one that they cannot is not among them.
        """
        return self.identity if self.prior is None else self.identity[: self.prior.n_principal]

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

    def sample(self, rng: np.random.Generator, *, sigma: float = 1.0) -> np.ndarray:
        """Identity coefficients (k,) of a random person, ``sigma`` standard deviations about the likeliest face.

        Examples
        --------
        >>> from toongeo.model import default_model
        >>> model = default_model()
        >>> model.vertices(model.sample(np.random.default_rng(0), sigma=0.8)).shape == model.mean.shape
        True
        """
        middle = np.zeros(len(self.identity)) if self.prior is None else self.prior.mean
        drawn = sigma * rng.standard_normal(len(self.identity))
        if self.prior is not None and self.prior.n_principal is not None:
            drawn[self.prior.n_principal :] = 0.0  # how drawings differ from people
        return middle + drawn

    @classmethod
    def from_arrays(cls, mean: ArrayLike, faces: ArrayLike, **parts: Any) -> MorphableModel:
        """A model of plain arrays in any unit; all are checked, and brought into the house frame.

        Parameters
        ----------
        mean : (n, 3) float
            +Y up, +Z out of the face. The origin moves midway between the eyeballs if there are landmarks.
        faces : (m, 3) int
            0-based; turned about if they face into the head.
        **parts
            Fields of this class; and ``unit``: millimetres a unit of ``mean``, ``identity`` and ``expression``, or
            ``"auto"`` for the power of ten that makes a head of human size; ``origin`` (3,), in the file's unit.

        Raises
        ------
        ValueError
            If shapes do not fit, numbers are not finite, or indices are out of range; names the array.

        Examples
        --------
        >>> from toongeo.model import default_model
        >>> metres = default_model().mean / 1000
        >>> model = MorphableModel.from_arrays(metres, default_model().faces, unit="auto")
        >>> model.has("landmarks"), model.identity.shape[0], round(float(np.ptp(model.mean[:, 0])) / 100)
        (False, 0, 2)
        """
        from toongeo.model.supply.from_arrays import from_arrays

        return from_arrays(mean, faces, **parts)

    def with_landmarks(self, vertices: ArrayLike) -> MorphableModel:
        """The same model with these vertices (68,) as landmarks; its origin moves midway between the eyes."""
        from toongeo.model.supply.with_landmarks import with_landmarks

        return with_landmarks(self, vertices)

    def with_contours(self) -> MorphableModel:
        """The same model with contour lines, so that jaw points slide along its outline; see `outline_paths`."""
        from toongeo.model.supply.outline_paths import with_contours

        return with_contours(self)

    def with_uv(self) -> MorphableModel:
        """The same model with texture coordinates; see `flattened`."""
        from toongeo.model.supply.flattened import with_uv

        return with_uv(self)

    def with_rig_of(self, template: MorphableModel | None = None) -> MorphableModel:
        """The people of this model on the surface of a template, with all that it has; see `on_template`."""
        from toongeo.model.supply.on_template import on_template

        return on_template(self, template)
