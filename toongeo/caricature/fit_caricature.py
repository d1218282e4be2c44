"""A 3D caricature from the landmarks of a picture."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.caricature.caricature_fit import CaricatureFit, CaricatureReport
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.face_space import FaceSpace, face_space
from toongeo.caricature.inner_parts import with_inner_parts
from toongeo.caricature.landmark_mesh import LandmarkMesh
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.pipeline.align.rim_anchors import rim_anchors
from toongeo.pipeline.fit.contour import landmarks_seen
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.landmark_basis import landmark_basis
from toongeo.pipeline.fit.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["fit_caricature"]

Floats = NDArray[np.float64]


def fit_caricature(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    *,
    space: FaceSpace | None = None,
    weight: float = 1e5,
    iterations: int = 4,
    start: CaricatureFit | None = None,
    options: CaricatureOptions | None = None,
) -> CaricatureFit:
    """A face as exaggerated as its landmarks ask for (Wu et al. 2018, Algorithm 1).

    Minimizes ``E_def(P', w) + weight * E_lan / s^2`` (Eq. 14) over the mesh P' and the weights w of a deformation
    space made of ordinary faces, in turns: the pose and the silhouette's landmark vertices for the face of w; the mesh
    between T(w) and the landmarks (Eq. 15); the weights that explain this mesh (Eq. 9). It begins at w = 0 and the
    pose of `fit_3dmm`.

    Two things are added to the paper's energy, both small where the space explains the landmarks, and both can be set
    to zero in the options: ``smoothness``, without which every landmark is the tip of a spike, and ``ridge``, without
    which weights grow in directions that the landmarks do not tell.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB or None
        Only its size is looked at, to check the landmarks against.
    landmarks : (68, 2) array_like, px
        iBUG-68 order; x right, y down, integer = pixel centre. NaN rows are missing.
    space : FaceSpace, optional
        `face_space` of the default model if None.
    weight : float > 0
        Lambda of Eq. 14. The paper's, 0.01, mixes px^2 with the model's unit; here E_lan is measured in (px / s)^2,
        with the camera's scale s in px/mm, so that both terms are mm^2 and the picture's resolution changes nothing.
        The default leaves about a hundredth of a millimetre.
    iterations : int
        P'-steps, at most.
    start : CaricatureFit, optional
        Begin at its weights, and keep its camera and its landmark vertices. With two iterations a new expression of
        a fitted face takes a fraction of a second.
    options : CaricatureOptions, optional

    Returns
    -------
    CaricatureFit

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8; if the landmarks have another shape, hold infinities, are fewer than 6,
        lie on a line or outside the picture; if weight or iterations are not positive; or if ``start`` is of another
        space.

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
    pixels = np.array(landmarks, np.float64)
    warnings = check_landmarks(pixels, None if img is None else img.shape)
    if not (np.isfinite(weight) and weight > 0):
        raise ValueError(f"weight: expected a finite number > 0, got {weight}")
    if iterations < 1:
        raise ValueError(f"iterations: expected at least 1, got {iterations}")
    space = face_space() if space is None else space
    if start is not None and start.space is not space:
        raise ValueError("start: expected a fit of the same space, got one of another")
    solver = _Alternation(space, pixels, weight, CaricatureOptions() if options is None else options)
    state = solver.first() if start is None else _resumed(start)
    before = solver.coarse.vertices if start is None else start.vertices
    P, state, energies = solver.run(state, iterations, posed=start is None)
    if start is None:
        before = before @ solver.first().camera.rotation.T @ state.camera.rotation
    V = with_inner_parts(space, before, P, tuck=solver.options.tuck)
    error = np.linalg.norm((state.camera.project(V[state.landmarks]) - pixels)[solver.seen], axis=1)
    report = CaricatureReport(
        iterations=len(energies),
        converged=solver.settled(energies),
        rms_px=float(np.sqrt((error**2).mean())),
        max_px=float(error.max()),
        warnings=tuple(warnings),
        seconds=time.perf_counter() - started,
    )
    return CaricatureFit(V, state.w, tuple(energies), state.camera, state.landmarks, space, report)


@dataclass(frozen=True, eq=False)
class _State:
    """What changes from step to step, but for the mesh."""

    w: Floats  # (2, l)
    camera: ScaledOrthographicCamera
    landmarks: NDArray[np.int64]  # (68,)


def _resumed(start: CaricatureFit) -> _State:
    if not isinstance(start.camera, ScaledOrthographicCamera):
        raise ValueError(f"start: expected a scaled orthographic camera, got {type(start.camera).__name__}")
    return _State(start.w, start.camera, start.landmark_vertices)


class _Alternation:
    """Algorithm 1 for one picture."""

    def __init__(self, space: FaceSpace, pixels: Floats, weight: float, options: CaricatureOptions) -> None:
        self.space, self.pixels, self.weight, self.options = space, pixels, weight, options
        self.seen = np.flatnonzero(np.isfinite(pixels).all(axis=1))
        self._mesh = _landmark_mesh(space, options.smoothness)

    @cached_property
    def coarse(self) -> FaceFit:
        """The ordinary face nearest to the landmarks: it gives the first pose, and the opening of mouth and eyes."""
        return fit_3dmm(None, self.pixels, model=self.space.model)

    def first(self) -> _State:
        camera = self.coarse.camera
        assert isinstance(camera, ScaledOrthographicCamera)
        return _State(np.zeros((2, len(self.space.space.rotations))), camera, self.coarse.landmark_vertices)

    def run(self, state: _State, iterations: int, *, posed: bool) -> tuple[Floats, _State, list[float]]:
        """Mesh (k, 3), state and E_def after each P'-step; ``posed``: whether the pose is found too."""
        space = self.space.space
        energies: list[float] = []
        while True:
            shape = space.vertices(state.w)
            if posed and energies:
                state = self._posed(shape, state)
            P = self._mesh_step(shape, state)
            energies.append(space.energy(P, state.w))
            if len(energies) == iterations or self.settled(energies):
                return P, state, energies
            w = space.fit(P, start=state.w, ridge=self.options.ridge, iterations=self.options.steps).w
            state = replace(state, w=w)

    def settled(self, energies: list[float]) -> bool:
        """Whether E_def hardly changed in the last step."""
        return len(energies) > 1 and abs(energies[-2] - energies[-1]) <= self.options.tolerance * energies[-2]

    def _posed(self, shape: Floats, state: _State) -> _State:
        """Camera that sees the landmarks of the face of w most nearly in their places (Eq. 13), and its silhouette.

        The face of w, not the mesh: that meets its landmarks under the old pose, and would keep it.
        """
        points = shape[self.space.rows(state.landmarks[self.seen])]
        camera = ScaledOrthographicCamera(*scaled_orthographic_pose(points, self.pixels[self.seen]))
        basis = landmark_basis(self.space.model)
        landmarks = landmarks_seen(basis, shape[self.space.rows(basis.vertices)], camera.rotation)
        return replace(state, camera=camera, landmarks=landmarks)

    def _mesh_step(self, shape: Floats, state: _State) -> Floats:
        """The P'-step (Eq. 15), with the rims of lids and lips between the landmarks."""
        vertices, first = np.unique(state.landmarks[self.seen], return_index=True)
        camera, model = state.camera, self.space.model
        missing_px = self.pixels - camera.project(shape[self.space.rows(state.landmarks)])
        rims, shift_px = rim_anchors(model, missing_px)
        fraction = np.where(model.region("lips")[rims], self.options.lip_weight, self.options.lid_weight)
        used = (fraction > 0) & ~np.isin(rims, vertices)
        rims, shift_px, fraction = self.space.rows(rims[used]), shift_px[used], fraction[used]
        targets_px = np.vstack([self.pixels[self.seen][first], camera.project(shape[rims]) + shift_px])
        weights = self.weight * np.r_[np.ones(len(vertices)), fraction]
        reference, rows = self.space.space.reference, np.r_[self.space.rows(vertices), rims]
        return reference + self._mesh.displacements(shape - reference, camera, rows, targets_px, weights)


@lru_cache(maxsize=2)
def _landmark_mesh(space: FaceSpace, smoothness: float) -> LandmarkMesh:
    """Kept, as its factor serves every picture."""
    return LandmarkMesh(space.space, smoothness)
