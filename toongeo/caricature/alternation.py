"""The turns of Algorithm 1 (Wu et al. 2018) for one picture: weights, pose, mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.caricature.caricature_fit import CaricatureFit
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.landmark_mesh import LandmarkMesh
from toongeo.caricature.level_camera import level_camera
from toongeo.caricature.smooth_warp import smooth_warp
from toongeo.caricature.space.face_space import FaceSpace
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.rim_anchors import rim_anchors
from toongeo.model.anatomy.visible_landmarks import landmarks_seen
from toongeo.pipeline.align.align_face import align_face
from toongeo.pipeline.align.denoise_landmarks import denoise_landmarks
from toongeo.pipeline.align.keep_rims_apart import keep_rims_apart
from toongeo.pipeline.align.symmetric_flow import symmetric_flow
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.protocols import HeadCamera
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["WEIGHT", "Alternation", "AlternationState"]

WEIGHT = 1e5  # lambda of Eq. 14, (px / s)^2 against mm^2


@dataclass(frozen=True, eq=False)
class AlternationState:
    """What changes from step to step (w, camera, landmarks), and what all began with."""

    w: Floats  # (2, l)
    camera: ScaledOrthographicCamera
    landmarks: NDArray[np.int64]  # (68,)
    fit: FaceFit  # the ordinary face
    before: Floats  # (n, 3) whose inner parts are right
    V: Floats  # (n, 3) on the landmarks, or nearly
    left: Floats | float = 0.0  # (k, 3) what the mesh of w lacked at the start
    posed: bool = True  # whether pose and silhouette are found too


class Alternation:
    """Algorithm 1 for one picture."""

    def __init__(self, space: FaceSpace, pixels: Floats, weight: float, options: CaricatureOptions) -> None:
        self.space, self.pixels, self.weight, self.options = space, pixels, weight, options
        self.seen = np.flatnonzero(np.isfinite(pixels).all(axis=1))
        self._mesh = _landmark_mesh(space, options.smoothness)

    def first(self, start: FaceFit | None) -> AlternationState:
        """The ordinary face nearest to the landmarks, aligned with them."""
        fit = fit_3dmm(None, self.pixels, model=self.space.model) if start is None else start
        if fit.model is not self.space.model:
            raise ValueError("start: expected a fit of the space's model, got one of another")
        self._denoise(fit)
        at = fit.vertices[fit.landmark_vertices[self.seen]]
        camera = level_camera(_orthographic(fit.camera), at, self.pixels[self.seen])
        face = align_face(replace(fit, camera=camera), self.pixels, noise=0)
        w = np.zeros((2, len(self.space.space.rotations)))
        return AlternationState(w, camera, face.landmark_vertices, fit, face.vertices, face.vertices)

    def resumed(self, start: CaricatureFit) -> AlternationState:
        """A caricature that has flowed to the landmarks."""
        if start.space is not self.space:
            raise ValueError("start: expected a fit of the same space, got one of another")
        self._denoise(start.fit)
        camera, before, landmarks = _orthographic(start.camera), start.vertices, start.landmark_vertices
        left = before[self.space.vertices] - self.space.space.vertices(start.w)
        V, _ = symmetric_flow(self.space.model, camera, before, landmarks, self.pixels, "scaled", False)
        return AlternationState(start.w, camera, landmarks, start.fit, before, V, left, posed=False)

    def _denoise(self, fit: FaceFit) -> None:
        self.pixels = denoise_landmarks(fit, self.pixels, self.options.noise).points

    def run(self, state: AlternationState, iterations: int) -> tuple[Floats, AlternationState, list[float], bool]:
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

    def _turn(self, P: Floats, state: AlternationState, centre: Floats) -> tuple[Floats, AlternationState, float]:
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

    def _posed(self, shape: Floats, state: AlternationState) -> AlternationState:
        """Camera that sees the landmarks of the face of w most nearly in their places (Eq. 13), and its silhouette.

        The face of w, not the mesh: that meets its landmarks under the old pose, and would keep it.
        """
        points = shape[self.space.rows(state.landmarks[self.seen])]
        camera = ScaledOrthographicCamera(*scaled_orthographic_pose(points, self.pixels[self.seen]))
        camera = level_camera(camera, points, self.pixels[self.seen])
        basis = landmark_basis(self.space.model)
        landmarks = landmarks_seen(basis, shape[self.space.rows(basis.vertices)], camera.rotation)
        return replace(state, camera=camera, landmarks=landmarks)

    def _mesh_step(self, shape: Floats, state: AlternationState) -> tuple[Floats, AlternationState]:
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

    def _anchors(self, V: Floats, state: AlternationState) -> tuple[NDArray[np.int64], Floats, Floats]:
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
