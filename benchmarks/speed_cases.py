"""Small problems, each solved by the library and by a rival, for `speed.py`."""

from collections.abc import Callable

import igl
import numpy as np
from kernels import PICTURE, z_buffer
from scipy.optimize import least_squares
from scipy.sparse import csr_array
from scipy.sparse.linalg import splu

from toongeo import (
    DeformationTransfer,
    LaplacianAligner,
    ScaledOrthographicCamera,
    default_model,
    deformation_transfer,
    diffuse_texture,
    fit_3dmm,
    read_landmarks,
)
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.render import FrameRenderer, Surface, rasterize, render_mesh

Pair = tuple[Callable[[], object], str, Callable[[], object]]  # ours, what the rival is called, the rival


def grid(count: int) -> tuple[np.ndarray, np.ndarray]:
    """A wavy sheet of about so many vertices."""
    side = round(count**0.5)
    y, x = np.mgrid[:side, :side] / side
    V = np.column_stack([x.ravel(), y.ravel(), 0.1 * np.sin(7 * x.ravel()) * np.cos(5 * y.ravel())])
    index = np.arange(side * side).reshape(side, side)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return V, np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def anchors(count: int) -> np.ndarray:
    return np.linspace(0, count - 1, 68).astype(int)


def sparse_lu(V: np.ndarray, F: np.ndarray, fixed: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """The alignment as one would write it down: normal equations, and the general solver of scipy."""
    L = igl.cotmatrix(V, F)
    C = csr_array((np.ones(len(fixed)), (np.arange(len(fixed)), fixed)), (len(fixed), len(V)))
    return splu((L.T @ L + C.T @ C).tocsc()).solve(L.T @ (L @ V) + C.T @ targets)


def align_new() -> Pair:
    V, F = grid(4000)
    fixed = anchors(len(V))
    targets = V[fixed] + 0.01
    return lambda: LaplacianAligner(V, F, fixed).align(targets), "scipy splu", lambda: sparse_lu(V, F, fixed, targets)


def align_again() -> Pair:
    V, F = grid(4000)
    fixed = anchors(len(V))
    aligner = LaplacianAligner(V, F, fixed)
    return (
        lambda: [aligner.align(V[fixed] + 0.01 * k) for k in range(20)],
        "the same, factored anew",
        lambda: [LaplacianAligner(V, F, fixed).align(V[fixed] + 0.01 * k) for k in range(20)],
    )


def transfer() -> Pair:
    V, F = grid(2000)
    target, shapes = V * [1, 1.3, 0.8], V + 0.05 * np.random.default_rng(0).standard_normal((8, 1, 3)) * V[:, :1]
    return (
        lambda: DeformationTransfer(V, F, target).transfer(shapes),
        "8 factorizations",
        lambda: [deformation_transfer(V, shape, F, target) for shape in shapes],
    )


def diffusion() -> Pair:
    rows, columns = np.mgrid[:160, :160]
    mask = ((columns - 80) / 60) ** 2 + ((rows - 80) / 70) ** 2 < 1
    img = np.random.default_rng(0).integers(0, 256, (160, 160, 3)).astype(np.uint8)
    return (
        lambda: [diffuse_texture(img, mask) for _ in range(4)],
        "queue in Python",
        lambda: [diffuse_texture(img, mask, order="sequential") for _ in range(4)],
    )


def head() -> tuple[np.ndarray, np.ndarray, ScaledOrthographicCamera]:
    model = default_model()
    return model.mean, model.faces, ScaledOrthographicCamera.look(size=256, centre=(0, -25, -30), extent=300)


def raster() -> Pair:
    V, F, camera = head()
    points = np.column_stack([camera.project(V), camera.depth(V)])
    return (
        lambda: [rasterize(points, F, 256, 256) for _ in range(4)],
        "z-buffer in numpy",
        lambda: [z_buffer(points, F, 256) for _ in range(4)],
    )


def frames() -> Pair:
    V, F, camera = head()
    surface = Surface(V, F, colours=np.clip(0.5 + V / 400, 0, 1))
    renderer = FrameRenderer([surface], camera, 256)
    return (
        lambda: [renderer.frame([V]) for _ in range(4)],
        "render_mesh",
        lambda: [render_mesh(surface, camera, 256) for _ in range(4)],
    )


def fit() -> Pair:
    """The same landmarks by the library, and by scipy with a Jacobian of differences over the same modes."""
    landmarks = read_landmarks(PICTURE.with_suffix(".pts"))
    model = default_model()
    some, basis = model.mean[model.landmarks], model.identity[:20, model.landmarks].astype(float)
    scale, rotation, translation = scaled_orthographic_pose(some, landmarks)

    def residual(x: np.ndarray) -> np.ndarray:
        points = (some + np.tensordot(x, basis, 1)) @ rotation.T
        return np.r_[(points[:, :2] * [scale, -scale] + translation - landmarks).ravel(), x]

    fit_3dmm(None, landmarks)  # what is prepared once for a model
    return (
        lambda: fit_3dmm(None, landmarks),
        "least_squares, 20 modes, pose fixed",
        lambda: least_squares(residual, np.zeros(20), "3-point"),
    )


CASES = {
    "align, new mesh": align_new,
    "align, same mesh, 20 times": align_again,
    "transfer of 8 shapes": transfer,
    "BFS diffusion 160²": diffusion,
    "rasterize a head 256²": raster,
    "frame of a film 256²": frames,
    "fit of 68 landmarks": fit,
}
