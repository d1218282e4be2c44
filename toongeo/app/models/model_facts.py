"""What there is to say of a model."""

from __future__ import annotations

import numpy as np

from toongeo.avatar.missing_parts import missing_parts
from toongeo.model import MorphableModel

__all__ = ["model_facts"]


def model_facts(model: MorphableModel) -> list[str]:
    """Lines on the size and the parts of a model, then what it lacks and how that is supplied.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> model_facts(default_model())[0]
    'vertices: 19057, triangles: 37568, quads: 18784'
    """
    size = np.ptp(model.mean, axis=0)
    named = model.expression_names[: model.n_named]
    lines = [
        f"vertices: {len(model.mean)}, triangles: {len(model.faces)}, quads: {len(model.quads)}",
        f"size: {size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} mm",
        f"identity: {len(model.identity)} modes{_strength(model)}",
        f"expressions: {len(named)} named, {len(model.expression) - len(named)} others",
        f"colours: {len(model.albedo)} modes",
        f"landmarks: {'68' if model.has('landmarks') else 'none'}, {_sliding(model)}",
        f"texture coordinates: {len(model.uv)}",
        f"eyeballs: {len(model.eyes)}",
        f"regions: {', '.join(sorted(model.regions)) or 'none'}",
    ]
    if model.skinning is not None:
        lines.append(f"joints: {', '.join(model.skinning.names)}")
    if named:
        lines.append(f"named expressions: {', '.join(named)}")
    return lines + [f"missing: {line}" for line in _lacking(model)]


def _strength(model: MorphableModel) -> str:
    if not len(model.identity):
        return ""
    rms = np.sqrt((model.identity.astype(float) ** 2).sum(axis=2).mean(axis=1))
    return f", {rms.max():.1f} mm the largest, {rms.min():.2g} mm the least"


def _sliding(model: MorphableModel) -> str:
    return "jaw points slide" if model.has("contours") else "jaw points do not slide"


def _lacking(model: MorphableModel) -> list[str]:
    lines = []
    if not model.has("landmarks"):
        lines.append("landmarks: --landmarks FILE, or model.with_landmarks(vertices)")
    elif not model.has("contours"):
        lines.append("contour lines: convert --contours, or model.with_contours()")
    if not model.has("uv"):
        lines.append("texture coordinates: convert --uv, or model.with_uv()")
    if not model.has("eyes", "mouth_cavity", "jawOpen"):
        lines.append("rig, eyeballs or mouth: convert --rig, or model.with_rig_of()")
    return lines + missing_parts(model)
