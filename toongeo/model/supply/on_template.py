"""The people of one model on the surface of another.

Constants are those of :func:`toongeo.nonrigid_register` and were judged on ICT-FaceKit and the Surrey model
(``benchmarks/models.py``), on no picture.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry import DeformationTransfer, vertex_normals
from toongeo.geometry.carry_shapes import carry_shapes
from toongeo.geometry.facing_surface import FacingSurface
from toongeo.geometry.nonrigid_register import RegisteredMesh, nonrigid_register
from toongeo.geometry.operators.adjacency import adjacency
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model.anatomy.hidden_vertices import hidden_vertices
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rim_anchors import rim_anchors
from toongeo.model.anatomy.rims import rim_path
from toongeo.model.anatomy.straighten_teeth import straighten_teeth
from toongeo.model.default_model import default_model
from toongeo.model.eyeball_template import EyeballTemplate
from toongeo.model.face_prior import FacePrior
from toongeo.model.ibug68 import INNER, PARTS
from toongeo.model.mirrored_vertices import mirrored_vertices
from toongeo.model.morphable_model import MorphableModel
from toongeo.model.supply.continued import continued

__all__ = ["on_template"]

_RIM_WEIGHT = 0.05  # of a landmark's: what lies between two of them on a rim is interpolated
_LEAST_MATCHED = 0.5  # of the template's face: with less the two are not the same kind of surface
_RIM_RINGS = 4  # of the template, about 20 mm on its scalp
_STILL = 1e-3  # of the largest motion: what moves less in every expression is held


def on_template(model: MorphableModel, template: MorphableModel | None = None) -> MorphableModel:
    """A model with the people of ``model``, and everything else of a template: its rig, mouth, eyeballs, texture.

    Scanned models are face masks: their eyes are skin, their lips one sheet, and nothing lies behind. A rig needs holes
    there. So it is not the template's parts that come to the model, but the model that comes to the template's surface:
    the template's mean is laid on the model's (:func:`toongeo.nonrigid_register`), each of its vertices takes the
    identity modes, own expressions and colours of the point on which it lies, what the model has not (the back of the
    head, the inside of mouth and sockets) bends along, and the named expressions come over by deformation transfer. The
    model's own expressions follow them without a name; those that bear one of the template's names take its place.

    Parameters
    ----------
    model : MorphableModel
        With landmarks; at rest, its mouth closed and its eyes open.
    template : MorphableModel, optional
        :func:`toongeo.default_model` unless given.

    Returns
    -------
    MorphableModel
        With the template's triangles, landmarks, contour lines and regions; its coefficients are those of ``model``.

    Raises
    ------
    ValueError
        If the model has no landmarks, or its mean is no face where they are.

    References
    ----------
    R. W. Sumner, J. Popovic, "Deformation transfer for triangle meshes", 2004.
    """
    template = default_model() if template is None else template
    if not model.has("landmarks"):
        raise ValueError("model: expected one with landmarks, got one without: model.with_landmarks(vertices)")
    if not (template.has("landmarks", "expression") and template.landmarks.size == model.landmarks.size):
        raise ValueError("template: expected a model with landmarks and named expressions")
    registration = _registered(template, model)
    mean = straighten_teeth(template, template.mean, _without_gaps(template, registration))
    outer = np.ones(len(model.mean), bool)
    shapes = np.concatenate([model.identity, model.expression])
    carried, partnered = carry_shapes(model.mean, model.faces, outer, shapes, mean, template.faces)
    carried = continued(mean, template.faces, _well_inside(partnered, template), carried)
    identity, own = carried[: len(model.identity)], carried[len(model.identity) :]
    eyes = tuple(_eye(template, k, mean, identity) for k in range(len(template.eyes)))
    origin = np.mean([eye.centre for eye in eyes], axis=0) if eyes else np.zeros(3)
    expression, names = _expressions(template, model, mean, own)
    return replace(
        template,
        mean=mean - origin,
        identity=identity,
        expression=expression,
        expression_names=names,
        n_named=template.n_named,
        mirror=template.mirror if template.has("quads") else mirrored_vertices(mean - origin),
        eyes=tuple(replace(eye, centre=eye.centre - origin) for eye in eyes),
        prior=None if template.prior is None else _prior(template.prior, len(identity)),
        skinning=None,
        **_colours(template, model, mean),
    )


def _registered(template: MorphableModel, model: MorphableModel) -> RegisteredMesh:
    points = model.mean[model.landmarks]
    scale, rotation, shift = similarity(template.mean[template.landmarks[INNER]], points[INNER])
    wanted = (points - shift) @ rotation / scale
    wanted[PARTS["jaw"]] = np.nan  # they lie on an outline that depends on the view, and every model has them elsewhere
    rim, moves = rim_anchors(template, wanted - template.mean[template.landmarks])
    rim_points = scale * (template.mean[rim] + moves) @ rotation.T + shift
    skin = ~hidden_vertices(template)
    registration = nonrigid_register(
        template.mean,
        template.faces,
        model.mean,
        model.faces,
        np.r_[template.landmarks[INNER], rim],
        np.vstack([points[INNER], rim_points]),
        fitted=skin,
        landmark_weight=np.r_[np.ones(len(INNER)), np.full(len(rim), _RIM_WEIGHT)],
    )
    matched = float(registration.matched[template.region("face") & skin].mean())
    if matched < _LEAST_MATCHED:
        raise ValueError(
            f"model: expected a face on which the template's fits, got one where {matched:.0%} of it finds a partner"
        )
    return registration


def _without_gaps(template: MorphableModel, registration: RegisteredMesh) -> NDArray[np.float64]:
    """The registered template, its skin smooth where the model had nothing to lay it on: a crown, a nape."""
    moved = registration.scale * template.mean @ registration.rotation.T + registration.shift
    known = _well_inside(registration.matched | hidden_vertices(template), template)
    return np.asarray(moved + continued(moved, template.faces, known, (registration.vertices - moved)[None])[0])


def _well_inside(known: NDArray[np.bool_], template: MorphableModel) -> NDArray[np.bool_]:
    """What is known, without its rim outside the features, where partners are the border of a surface or beyond it."""
    inside, graph = known.copy(), adjacency(template.faces, len(known))
    kept = known & template.region("face") & ~template.region("forehead")
    for _ in range(_RIM_RINGS):
        inside &= (graph @ (~inside).astype(float) == 0) | kept
    return inside


def _expressions(
    template: MorphableModel, model: MorphableModel, mean: NDArray[np.float64], own: NDArray[np.float32]
) -> tuple[NDArray[np.float32], tuple[str, ...]]:
    """The template's named expressions on this mean, then the model's own that bear no name of theirs."""
    shapes = template.expression[: template.n_named].astype(np.float64)
    motion = np.abs(shapes).max(axis=(0, 2))
    still = np.flatnonzero(motion <= _STILL * motion.max())
    transfer = DeformationTransfer(template.mean, template.faces, mean, pinned=still, weights="area")
    moved = (transfer.transfer(template.mean + shapes) - mean).astype(np.float32)
    names = template.expression_names[: template.n_named]
    more = [k for k, name in enumerate(model.expression_names) if name not in names]
    extra = tuple(f"extra{i + 1:02d}" for i in range(len(more)))
    return np.concatenate([moved, own[more]]), (*names, *extra)


def _eye(
    template: MorphableModel, side: int, mean: NDArray[np.float64], identity: NDArray[np.float32]
) -> EyeballTemplate:
    """An eyeball of the template where its lids are now; it goes with them from person to person."""
    eye = template.eyes[side]
    rims = [rim_path(template, f"lid_{lid}_{SIDES[side]}") for lid in ("upper", "lower")]
    lids = np.unique(np.concatenate(rims))
    scale, rotation, shift = similarity(template.mean[lids], mean[lids])
    return replace(
        eye,
        centre=scale * rotation @ eye.centre + shift,
        radius=scale * eye.radius,
        centre_modes=identity[:, lids].mean(axis=1, dtype=np.float64).astype(np.float32),
        radius_modes=np.zeros(len(identity), np.float32),
    )


def _colours(template: MorphableModel, model: MorphableModel, mean: NDArray[np.float64]) -> dict[str, Any]:
    """The model's colours, if it has any, at the nearest points of its surface."""
    if not model.has("albedo"):
        return {}
    triangles, bary, _ = FacingSurface(model.mean, model.faces).closest(mean, vertex_normals(mean, template.faces))
    corners = model.faces[triangles]

    def sampled(values: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.einsum("nc,ncd->nd", bary, values[corners]).astype(np.float32)

    return {
        "albedo_mean": np.clip(sampled(model.albedo_mean), 0, 1),
        "albedo": np.array([sampled(mode) for mode in model.albedo], np.float32),
    }


def _prior(prior: FacePrior, n_modes: int) -> FacePrior:
    """Annotators see the template's landmarks where they did; the mean of the model is its likeliest face."""
    return replace(prior, mean=np.zeros(n_modes), n_principal=None)
