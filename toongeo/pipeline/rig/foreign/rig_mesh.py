"""A rig for a head that was modelled elsewhere.

Constants were judged on ICT-FaceKit's head and the template (``benchmarks/register.py``), on no picture.
"""

import time

import numpy as np
from numpy.typing import ArrayLike

from toongeo.geometry import DeformationTransfer, MeshLike, validate_mesh
from toongeo.geometry.border_twins import border_twins
from toongeo.geometry.carry_shapes import carry_shapes
from toongeo.geometry.landmark_matrix import landmark_matrix
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model import MorphableModel, default_model
from toongeo.model.anatomy.hidden_vertices import hidden_vertices
from toongeo.model.anatomy.straighten_teeth import PARTS
from toongeo.model.ibug68 import INNER, MIRROR
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.foreign.back_to_dense import back_to_dense
from toongeo.pipeline.rig.foreign.check_winding import check_winding
from toongeo.pipeline.rig.foreign.close_gaps import close_gaps
from toongeo.pipeline.rig.foreign.loose_parts import MouthParts, settle_loose_parts
from toongeo.pipeline.rig.foreign.mouth_opens import mouth_opens
from toongeo.pipeline.rig.foreign.register_face import register_face
from toongeo.pipeline.rig.foreign.thinned_mesh import thinned_mesh
from toongeo.pipeline.rig.rig import Rig, RigReport
from toongeo.pipeline.rig.split_gaze import split_gaze

__all__ = ["rig_mesh"]

_LEAST_LANDMARKS = 12  # of the inner ones
_LIKENESS = 0.5  # of their spread: how far landmarks of a face may be from the model's, root mean square
_EXCHANGED = 0.5  # of the misfit: what is left of it with the sides exchanged, if they were
_STILL = 1e-3  # of the largest motion: what moves less in every expression is held
_MOST_VERTICES = 60_000  # three times the template's; a denser head is thinned for the work, which takes minutes else
_TORN = 0.1  # of the vertices: more copies are no seams of a texture, but loose triangles
_LEAST_MATCHED = 0.5  # of the face: with less the two are not the same kind of surface


def rig_mesh(
    V: MeshLike,
    F: ArrayLike | None,
    landmarks: ArrayLike,
    *,
    model: MorphableModel | None = None,
    weld: bool | None = None,
) -> Rig:
    """Give a neutral head of any topology the named expressions of a model.

    The model's mean is laid on the head by landmarks and non-rigid closest points
    (:func:`toongeo.nonrigid_register`), takes over the gradients of the expressions there (Sumner and Popovic's
    transfer, triangles weighted by area), and closes the gaps that blinks have left. Every vertex of the head then
    moves as the point of the model's mesh that lies on it; parts without one follow their surroundings, teeth as the
    model's teeth, eyeballs not at all.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        The head at rest, mouth closed and eyes open; any unit, any pose.
    F : (m, 3) int, or None with a Trimesh
        Triangles, counter-clockwise from outside.
    landmarks : (68,) int or (68, 3) float
        iBUG-68: vertices, or points on the surface in the frame of `V`. NaN rows are missing. Jaw points (0-16) are not
        needed; of the others at least twelve are.
    model : MorphableModel, optional
        :func:`toongeo.default_model` unless given.
    weld : bool, optional
        Take vertices at borders that share a place for one: for meshes of files that repeat vertices at the seams of
        their textures (GLB, PLY) or at every triangle (STL). They stay as they are in the result, and move alike.
        None: if the mesh is torn, so that one in ten of its vertices or more is such a copy.

    Returns
    -------
    Rig
        ``names``, ``neutral`` (`V`) and ``deltas`` (k, n, 3) in the frame and unit of `V`; nothing follows the gaze
        unless the model has shapes of its names.
        ``report`` holds ``seconds``, ``matched`` (share of the model's face that found a partner), ``distance`` (its
        mean distance, in units of `V`), ``partnered`` (share of the head's vertices) and ``mouth_opens`` (False if the
        lips are one surface, which expressions only stretch). Heads of more than 60,000 vertices are thinned for the
        work; the vertices between move along.

    Raises
    ------
    ValueError
        On a malformed mesh, landmarks of another shape, out of range or too few, triangles that face into the head, or
        a mesh that is no face where the landmarks are; if the model has no expressions.

    See Also
    --------
    build_rig : for a face of the model's own topology.

    References
    ----------
    R. W. Sumner, J. Popovic, "Deformation transfer for triangle meshes", ACM TOG 23(3), 2004.

    Examples
    --------
    >>> model = default_model()
    >>> front = model.faces[model.region("face")[model.faces].all(1)]
    >>> rig = rig_mesh(0.1 * model.mean, front, model.landmarks)
    >>> rig.deltas.shape[0], rig.vertices({"jawOpen": 1.0}).shape == model.mean.shape
    (46, True)
    """
    started = time.perf_counter()
    model = model or default_model()
    if not model.has("expression"):
        raise ValueError("model: expected one with named expressions, got one without")
    neutral, faces = validate_mesh(V, F)
    points = _checked_points(neutral, faces, landmarks, model)
    middle = np.nanmean(points, axis=0)  # far from the origin, as on a map, digits are few
    vertices, points = neutral - middle, points - middle
    twin = _twins(vertices, faces, weld)
    faces = twin[faces]
    whole = np.unique(faces)
    # Vertices in no triangle have no surface around them, and stay.
    all_local = np.searchsorted(whole, faces)
    kept, local = thinned_mesh(vertices[whole], all_local, _MOST_VERTICES)
    used = whole[kept]
    check_winding(vertices[used], local, points, model)
    head = register_face(vertices[used], local, points, model)
    skin = ~hidden_vertices(model)
    face = model.region("face") & skin
    matched = float(head.registration.matched[face].mean())
    if matched < _LEAST_MATCHED:
        raise ValueError(
            f"V: expected a head on which the model's face fits, with triangles counter-clockwise from outside, "
            f"got one where {matched:.0%} of it finds a partner"
        )
    shapes = head.to_foreign(_transferred(head.face))
    carrier = head.registration.vertices.copy()
    carrier[~skin] = head.to_foreign(head.face.vertices[~skin]) + head.shift
    carried, partnered = carry_shapes(carrier, model.faces, skin, shapes, vertices[used], local)
    mouth = _mouth_parts(model, carrier, shapes)
    settled = settle_loose_parts(vertices[used], local, points, carried, partnered, mouth).astype(np.float32)
    del carried
    if len(kept) < len(whole):
        settled = back_to_dense(vertices[whole], all_local, kept, local, settled)
    place = np.full(len(vertices), -1)
    place[whole] = np.arange(len(whole))
    deltas = np.zeros((len(shapes), len(vertices), 3), np.float32)
    moving = place[twin] >= 0
    deltas[:, moving] = settled[:, place[twin][moving]]
    names, deltas, gaze = split_gaze(model.expression_names[: model.n_named], deltas)
    return Rig(
        names=names,
        neutral=neutral.copy(),
        deltas=deltas,
        gaze=gaze,
        pose=np.zeros(len(names)),
        report=RigReport(
            seconds=time.perf_counter() - started,
            matched=matched,
            distance=float(head.registration.distances[face & head.registration.matched].mean()),
            partnered=float(partnered.mean()),
            mouth_opens=mouth_opens(vertices[used], local, points),
        ),
    )


def _twins(V: np.ndarray, F: np.ndarray, weld: bool | None) -> np.ndarray:
    """For each vertex the one that it is taken for."""
    own = np.arange(len(V))
    if weld is False:
        return own
    twin = border_twins(V, F)
    return twin if weld or (twin != own).mean() > _TORN else own


def _checked_points(V: np.ndarray, F: np.ndarray, landmarks: ArrayLike, model: MorphableModel) -> np.ndarray:
    """Landmarks as points (68, 3); NaN rows are missing."""
    matrix, given = landmark_matrix(V, F, landmarks, "landmarks")
    if len(given) != 68:
        raise ValueError(f"landmarks: expected 68 vertices or points (iBUG-68), got {len(given)}")
    if given[INNER].sum() < _LEAST_LANDMARKS:
        raise ValueError(
            f"landmarks: expected at least {_LEAST_LANDMARKS} of the points 17-67, got {given[INNER].sum()}"
        )
    points = np.where(given[:, None], matrix @ V, np.nan)
    inner = INNER[given[INNER]]
    own, found = model.mean[model.landmarks[inner]], points[inner]
    spread = np.sqrt(((found - found.mean(0)) ** 2).sum(1).mean())
    if not spread > 0:
        raise ValueError("landmarks: expected the points of a face, got one place for all")
    misfit = _misfit(own, found) / spread
    if _misfit(model.mean[model.landmarks[MIRROR[inner]]], found) / spread < _EXCHANGED * misfit:
        raise ValueError(
            "landmarks: left and right are exchanged, or the mesh is mirrored: points 0-7, 17-21 and 36-41 are the "
            "subject's right side"
        )
    if not misfit <= _LIKENESS:
        raise ValueError(
            f"landmarks: expected the points of a face in the order of iBUG-68, got ones that are off by "
            f"{misfit:.0%} of their spread from the model's, however it is turned"
        )
    return points


def _misfit(points: np.ndarray, targets: np.ndarray) -> float:
    """Root mean square distance of points (k, 3), moved, turned and scaled, from targets."""
    scale, rotation, shift = similarity(points, targets)
    return float(np.sqrt(((targets - scale * points @ rotation.T - shift) ** 2).sum(1).mean()))


def _mouth_parts(model: MorphableModel, vertices: np.ndarray, shapes: np.ndarray) -> MouthParts:
    parts = tuple(model.regions[name] for name in PARTS if name in model.regions)
    mouth = [*parts, model.regions.get("mouth_cavity", np.zeros(len(vertices), bool))]
    return MouthParts(vertices, shapes, np.any(mouth, axis=0), parts)


def _transferred(face: AlignedFace) -> np.ndarray:
    """Displacements (k, n, 3) of the model's expressions on this face, mm; the blinks leave no gap."""
    model = face.model
    shapes = model.expression[: model.n_named].astype(np.float64)
    motion = np.abs(shapes).max(axis=(0, 2))
    still = np.flatnonzero(motion <= _STILL * motion.max())
    transfer = DeformationTransfer(model.mean, model.faces, face.vertices, pinned=still, weights="area")
    moved = transfer.transfer(model.mean + shapes)
    for side in ("left", "right"):
        name = f"eyeBlink{side.capitalize()}"
        if name in model.expression_names[: model.n_named]:
            k = model.expression_index(name)
            moved[k] = close_gaps(model, face.vertices, moved[k], side)
    return moved - face.vertices
