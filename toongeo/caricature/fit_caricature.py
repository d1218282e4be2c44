"""A 3D caricature from the landmarks of a picture."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats
from toongeo.caricature.caricature_fit import CaricatureFit, CaricatureReport
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.inner_parts import with_inner_parts
from toongeo.caricature.landmark_mesh import LandmarkMesh
from toongeo.caricature.level_camera import level_camera
from toongeo.caricature.smooth_warp import smooth_warp
from toongeo.caricature.space.face_space import FaceSpace, face_space
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.rim_anchors import rim_anchors
from toongeo.model.anatomy.visible_landmarks import landmarks_seen
from toongeo.pipeline.align.align_face import align_face
from toongeo.pipeline.align.denoise_landmarks import denoise_landmarks
from toongeo.pipeline.align.keep_rims_apart import keep_rims_apart
from toongeo.pipeline.align.symmetric_flow import symmetric_flow
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.protocols import HeadCamera
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["fit_caricature", "refitted_skin"]

_WEIGHT = 1e5  # lambda of Eq. 14, (px / s)^2 against mm^2


def fit_caricature(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    *,
    space: FaceSpace | None = None,
    weight: float = _WEIGHT,
    iterations: int = 4,
    start: CaricatureFit | FaceFit | None = None,
    options: CaricatureOptions | None = None,
    scheme: str = "ibug68",
) -> CaricatureFit:
    """A face as exaggerated as its landmarks ask for (Wu et al. 2018, Algorithm 1).

    Minimizes ``E_def(P', w) + weight * E_lan / s^2`` (Eq. 14) over the mesh P' and the weights w of a deformation
    space made of ordinary faces, in turns: the weights that explain the mesh (Eq. 9); the pose and the silhouette's
    landmark vertices for the face of w (Eq. 13); the mesh between T(w) and the landmarks (Eq. 15).

    Three things differ from the paper, because its energy alone folds lips and lids, makes a spike of each landmark,
    and predicts badly what no landmark shows. It begins with the mesh that `align_face` gives instead of w = 0. A
    P'-step does not take the mesh of w as it is, whose lips and lids can pass through each other: the aligned face
    follows it by a smooth map of space (`looseness` in the options), and flows on to the landmarks by the likeliest
    motion when left and right move alike; what is then left of the way, next to nothing, is closed by the energy
    (with `smoothness`). And `ridge` keeps weights small that the landmarks do not tell.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB or None
        Only its size is looked at, to check the landmarks against.
    landmarks : (68, 2) array_like, px
        iBUG-68 order; x right, y down, integer = pixel centre. NaN rows are missing.
    space : FaceSpace, optional
        `face_space` of the default model, or that of ``start``, if None.
    weight : float > 0
        Lambda of Eq. 14. The paper's, 0.01, mixes px^2 with the model's unit; here E_lan is measured in (px / s)^2,
        with the camera's scale s in px/mm, so that both terms are mm^2 and the picture's resolution changes nothing.
        The default leaves about a hundredth of a millimetre.
    iterations : int
        P'-steps, at most. It ends earlier when E_def falls by less than the tolerance of the options; if it rises, as
        another silhouette can make it, the step before is the result.
    start : CaricatureFit or FaceFit, optional
        Of a caricature: go on from it with its weights, its camera and its landmark vertices, keeping also what its
        space does not explain. The same landmarks give nearly the same face, and with one iteration a new expression
        takes a third of a second. Of an ordinary face: begin with this one instead of the `fit_3dmm` of the landmarks.
    options : CaricatureOptions, optional
    scheme : str
        What the landmarks are: see :func:`toongeo.ibug_landmarks`.

    Returns
    -------
    CaricatureFit

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8; if the landmarks have another shape, hold infinities, are fewer than 6,
        lie on a line or outside the picture; if weight or iterations are not positive; or if ``start`` is of another
        space or model, or has a perspective camera.

    References
    ----------
    Wu, Zhang, Lai, Zheng, Cai 2018, "Alive caricature from 2D to 3D".

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> model = default_model()
    >>> points = ScaledOrthographicCamera.look(yaw=20.0).project(model.mean[model.landmarks])
    >>> fit = fit_caricature(None, points * [1.0, 1.3], iterations=2)
    >>> fit.report.rms_px < 0.03
    True
    """
    started = time.perf_counter()
    if img is not None:
        check_image(img)
    pixels = ibug_landmarks(landmarks, scheme)
    warnings = check_landmarks(pixels, None if img is None else img.shape)
    if not (np.isfinite(weight) and weight > 0):
        raise ValueError(f"weight: expected a finite number > 0, got {weight}")
    if iterations < 1:
        raise ValueError(f"iterations: expected at least 1, got {iterations}")
    if space is None:
        space = start.space if isinstance(start, CaricatureFit) else face_space(start.model if start else None)
    solver = _Alternation(space, pixels, weight, CaricatureOptions() if options is None else options)
    state = solver.resumed(start) if isinstance(start, CaricatureFit) else solver.first(start)
    P, state, energies, converged = solver.run(state, iterations)
    V = with_inner_parts(space, state.before, P, tuck=solver.options.tuck)
    error = np.linalg.norm((state.camera.project(V[state.landmarks]) - pixels)[solver.seen], axis=1)
    report = CaricatureReport(
        iterations=len(energies),
        converged=converged,
        rms_px=float(np.sqrt((error**2).mean())),
        max_px=float(error.max()),
        warnings=tuple(warnings),
        seconds=time.perf_counter() - started,
    )
    return CaricatureFit(V, state.w, tuple(energies), state.camera, state.landmarks, space, state.fit, report)


def refitted_skin(start: CaricatureFit, pixels: Floats, options: CaricatureOptions) -> Floats:
    """Vertices (k, 3) of the space after one turn of `fit_caricature` to other landmarks (68, 2) px.

    Mouth and sockets, which would follow, are left alone.
    """
    solver = _Alternation(start.space, pixels, _WEIGHT, options)
    return solver.run(solver.resumed(start), 1)[0]


@dataclass(frozen=True, eq=False)
class _State:
    """What changes from step to step (w, camera, landmarks), and what all began with."""

    w: Floats  # (2, l)
    camera: ScaledOrthographicCamera
    landmarks: NDArray[np.int64]  # (68,)
    fit: FaceFit  # the ordinary face
    before: Floats  # (n, 3) whose inner parts are right
    V: Floats  # (n, 3) on the landmarks, or nearly
    left: Floats | float = 0.0  # (k, 3) what the mesh of w lacked at the start
    posed: bool = True  # whether pose and silhouette are found too


class _Alternation:
    """Algorithm 1 for one picture."""

    def __init__(self, space: FaceSpace, pixels: Floats, weight: float, options: CaricatureOptions) -> None:
        self.space, self.pixels, self.weight, self.options = space, pixels, weight, options
        self.seen = np.flatnonzero(np.isfinite(pixels).all(axis=1))
        self._mesh = _landmark_mesh(space, options.smoothness)

    def first(self, start: FaceFit | None) -> _State:
        """The ordinary face nearest to the landmarks, aligned with them."""
        fit = fit_3dmm(None, self.pixels, model=self.space.model) if start is None else start
        if fit.model is not self.space.model:
            raise ValueError("start: expected a fit of the space's model, got one of another")
        self._denoise(fit)
        at = fit.vertices[fit.landmark_vertices[self.seen]]
        camera = level_camera(_orthographic(fit.camera), at, self.pixels[self.seen])
        face = align_face(replace(fit, camera=camera), self.pixels, noise=0)
        w = np.zeros((2, len(self.space.space.rotations)))
        return _State(w, camera, face.landmark_vertices, fit, face.vertices, face.vertices)

    def resumed(self, start: CaricatureFit) -> _State:
        """A caricature that has flowed to the landmarks."""
        if start.space is not self.space:
            raise ValueError("start: expected a fit of the same space, got one of another")
        self._denoise(start.fit)
        camera, before, landmarks = _orthographic(start.camera), start.vertices, start.landmark_vertices
        left = before[self.space.vertices] - self.space.space.vertices(start.w)
        V, _ = symmetric_flow(self.space.model, camera, before, landmarks, self.pixels, "scaled", False)
        return _State(start.w, camera, landmarks, start.fit, before, V, left, posed=False)

    def _denoise(self, fit: FaceFit) -> None:
        self.pixels = denoise_landmarks(fit, self.pixels, self.options.noise).points

    def run(self, state: _State, iterations: int) -> tuple[Floats, _State, list[float], bool]:
        """Mesh (k, 3) and state of the least E_def, E_def after the P'-steps up to it, and whether it fell no more."""
        best = self._turn(state.V[self.space.vertices], state, state.w)
        energies = [best[2]]
        for _ in range(iterations - 1):
            turn = self._turn(best[0], best[1], state.w)
            if turn[2] < energies[-1]:
                best = turn
                energies.append(turn[2])
            if turn[2] > (1 - self.options.tolerance) * energies[-2 if turn is best else -1]:
                return *best[:2], energies, True
        return *best[:2], energies, False

    def _turn(self, P: Floats, state: _State, centre: Floats) -> tuple[Floats, _State, float]:
        """w-step, pose and P'-step: mesh (k, 3), state and E_def."""
        space, options, left = self.space.space, self.options, state.left
        steps = options.steps if state.posed else 1  # weights that change little
        w = space.fit(P - left, start=state.w, ridge=options.ridge, centre=centre, iterations=steps).w
        shape = space.vertices(w) + left
        state = replace(state, w=w)
        if state.posed:
            state = self._posed(shape, state)
        P, state = self._mesh_step(shape, state)
        return P, state, space.energy(P - left, w)

    def _posed(self, shape: Floats, state: _State) -> _State:
        """Camera that sees the landmarks of the face of w most nearly in their places (Eq. 13), and its silhouette.

        The face of w, not the mesh: that meets its landmarks under the old pose, and would keep it.
        """
        points = shape[self.space.rows(state.landmarks[self.seen])]
        camera = ScaledOrthographicCamera(*scaled_orthographic_pose(points, self.pixels[self.seen]))
        camera = level_camera(camera, points, self.pixels[self.seen])
        basis = landmark_basis(self.space.model)
        landmarks = landmarks_seen(basis, shape[self.space.rows(basis.vertices)], camera.rotation)
        return replace(state, camera=camera, landmarks=landmarks)

    def _mesh_step(self, shape: Floats, state: _State) -> tuple[Floats, _State]:
        """The P'-step (Eq. 15): after the mesh of w, then with the likeliest flow, then exactly to the landmarks."""
        model, camera = self.space.model, state.camera
        V = smooth_warp(self.space, state.V, shape, self.options.looseness)
        if state.posed:  # else the pose is that in which V has flowed, and the warp takes it but little off
            V, landmarks = symmetric_flow(model, camera, V, state.landmarks, self.pixels, "scaled", True)
            state = replace(state, landmarks=landmarks)
        anchors, targets_px, fractions = self._anchors(V, state)
        reference, P = self.space.space.reference, V[self.space.vertices]
        rows, weights = self.space.rows(anchors), self.weight * fractions
        return reference + self._mesh.displacements(P - reference, camera, rows, targets_px, weights), state

    def _anchors(self, V: Floats, state: _State) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Vertices (a,), pixels (a, 2) and weights (a,) of the landmarks and of the rims between them."""
        model, camera = self.space.model, state.camera
        vertices, first = np.unique(state.landmarks[self.seen], return_index=True)
        rims, shift_px = rim_anchors(model, self.pixels - camera.project(V[state.landmarks]))
        used = ~np.isin(rims, vertices) & (self.options.rim_weight > 0)
        rims, shift_px = rims[used], shift_px[used]
        anchors, given = np.r_[vertices, rims], np.arange(len(vertices) + len(rims)) < len(vertices)
        targets_px = np.vstack([self.pixels[self.seen][first], camera.project(V[rims]) + shift_px])
        # The depth stays: rims of a mouth that is drawn shut may touch.
        targets_px, _ = keep_rims_apart(model, camera, V, anchors, targets_px, given)
        return anchors, targets_px, np.where(given, 1.0, self.options.rim_weight)


def _orthographic(camera: HeadCamera) -> ScaledOrthographicCamera:
    if not isinstance(camera, ScaledOrthographicCamera):
        raise ValueError(f"start: expected a scaled orthographic camera, got {type(camera).__name__}")
    return camera


@lru_cache(maxsize=2)
def _landmark_mesh(space: FaceSpace, smoothness: float) -> LandmarkMesh:
    """Kept, as its factor serves every picture."""
    return LandmarkMesh(space.space, smoothness)
