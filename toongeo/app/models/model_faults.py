"""What looks wrong with a model."""

from __future__ import annotations

import numpy as np

from toongeo.geometry.operators.components import components
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel, default_model
from toongeo.model.ibug68 import INNER, MIRROR, OUTER_EYES

__all__ = ["model_faults"]

_LIKENESS = 0.35  # of their spread: how far landmarks of a human face are from the template's, root mean square
_EYES_MM = (60.0, 130.0)  # between the outer corners: children to caricatures
_DEGENERATE = 1e-9  # mm^2
_STRONGEST_MM = 60.0  # a standard deviation of any one mode


def model_faults(model: MorphableModel) -> list[str]:
    """Sentences on what looks wrong: none for a model as it should be.

    Looked at are the size, triangles, how far modes reach, and whether the landmarks form a face: a wrong table shows
    as one with sides exchanged or points in another order.

    Examples
    --------
    >>> model_faults(default_model())
    []
    """
    faults = [*_mesh_faults(model), *_mode_faults(model)]
    if not model.has("landmarks"):
        return [*faults, "landmarks: there are none; a fit needs 68"]
    return faults + _landmark_faults(model)


def _mesh_faults(model: MorphableModel) -> list[str]:
    faults = []
    corners = model.mean[model.faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    if (areas <= _DEGENERATE).any():
        faults.append(f"faces: {int((areas <= _DEGENERATE).sum())} triangles have no area")
    edges = np.concatenate([model.faces[:, [0, 1]], model.faces[:, [1, 2]], model.faces[:, [2, 0]]])
    _, counts = np.unique(edges[:, 0] * len(model.mean) + edges[:, 1], return_counts=True)
    if (counts > 1).any():
        faults.append(f"faces: {int((counts > 1).sum())} edges run the same way in two triangles")
    pieces = np.bincount(components(model.faces, len(model.mean)))
    if (pieces == 1).any():
        faults.append(f"mean: {int((pieces == 1).sum())} vertices are in no triangle")
    return faults


def _mode_faults(model: MorphableModel) -> list[str]:
    faults = []
    for name, modes in (("identity", model.identity), ("expression", model.expression)):
        reach = np.sqrt((modes.astype(float) ** 2).sum(axis=2).mean(axis=1)) if len(modes) else np.zeros(0)
        if (reach > _STRONGEST_MM).any():
            faults.append(f"{name}: mode {int(reach.argmax())} moves vertices by {reach.max():.0f} mm on average")
        if name == "identity" and (reach == 0).any():
            faults.append(f"{name}: {int((reach == 0).sum())} modes move nothing")
    return faults


def _landmark_faults(model: MorphableModel) -> list[str]:
    points, template = model.mean[model.landmarks], default_model()
    eyes = float(np.linalg.norm(np.subtract(*points[list(OUTER_EYES)])))
    faults = []
    if not _EYES_MM[0] < eyes < _EYES_MM[1]:
        faults.append(f"mean: the outer corners of the eyes are {eyes:.0f} mm apart; people's are about 90")
    if points[OUTER_EYES[1], 0] < points[OUTER_EYES[0], 0]:
        faults.append("landmarks: left and right are exchanged: points 36-41 are the subject's right eye, -X")
    own = template.mean[template.landmarks]
    misfit, exchanged = (_misfit(own[order], points[INNER]) for order in (INNER, MIRROR[INNER]))
    if exchanged < 0.5 * misfit:
        faults.append("landmarks: they fit a face better with the sides exchanged")
    elif misfit > _LIKENESS:
        faults.append(f"landmarks: they are off by {misfit:.0%} of their spread from those of a face in iBUG-68 order")
    doubled = len(INNER) - len(np.unique(model.landmarks[INNER]))
    if doubled > 2:  # inner mouth corners may share the outer ones' vertices
        faults.append(f"landmarks: {doubled} of the inner points share a vertex with another")
    return faults


def _misfit(own: np.ndarray, found: np.ndarray) -> float:
    scale, rotation, shift = similarity(own, found)
    spread = np.sqrt(((found - found.mean(axis=0)) ** 2).sum(axis=1).mean())
    return float(np.sqrt(((found - scale * own @ rotation.T - shift) ** 2).sum(axis=1).mean()) / max(spread, 1e-9))
