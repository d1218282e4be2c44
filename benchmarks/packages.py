"""What a library does against what we, or another library, do: the measurements behind docs/dependencies.md.

usage: python benchmarks/packages.py [HEAD.obj]

On the template, one thread, CPU time (so that other work on the machine counts less). Without an OBJ the template's own
is written and read.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import cv2
import igl
import numpy as np
import scipy.sparse as sp
import trimesh
from scipy import ndimage
from skimage import color, draw, measure, morphology, transform

from toongeo import ScaledOrthographicCamera, default_model
from toongeo.geometry import (
    cotangent_laplacian,
    deformation_gradients,
    polar_decomposition,
    vertex_components,
    vertex_normals,
)
from toongeo.geometry.deformation.transfer_operators import transfer_operators
from toongeo.io import Scene, SceneMesh, read_obj, write_obj
from toongeo.render import rasterize


def best(run: Callable[[], object], times: int = 9) -> float:
    """Least CPU milliseconds of several runs, after one that does not count."""
    run()
    spent = []
    for _ in range(times):
        started = time.process_time()
        run()
        spent.append(time.process_time() - started)
    return 1000 * min(spent)


def row(work: str, used: str, ours: Callable[[], object], rival: str, theirs: Callable[[], object]) -> None:
    a, b = best(ours), best(theirs)
    print(f"| {work} | {used} | {a:.2f} | {rival} | {b:.2f} | {b / a:.1f} |", flush=True)


def numpy_normals(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    area = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    corners, thrice = F.T.ravel(), np.tile(area, (3, 1))
    total = np.stack([np.bincount(corners, column, len(V)) for column in thrice.T], axis=1)
    return total / np.linalg.norm(total, axis=1, keepdims=True)


def numpy_cotangents(V: np.ndarray, F: np.ndarray) -> sp.csr_matrix:
    rows, columns, weights = [], [], []
    for k in range(3):
        tip, i, j = np.roll(F, -k, axis=1).T
        u, v = V[i] - V[tip], V[j] - V[tip]
        half = 0.5 * (u * v).sum(1) / np.linalg.norm(np.cross(u, v), axis=1)
        rows, columns, weights = rows + [i, j], columns + [j, i], weights + [half, half]
    W = sp.csr_matrix((np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))), (len(V), len(V)))
    return sp.csr_matrix(sp.diags_array(W.sum(axis=1).A1) - W)


def scipy_adjacency(F: np.ndarray, n: int) -> sp.csr_matrix:
    i, j = F.ravel(), np.roll(F, -1, axis=1).ravel()
    A = sp.csr_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), (n, n))
    A.data[:] = 1.0
    return A


def gradient_products(V: np.ndarray, target: np.ndarray, F: np.ndarray) -> tuple[sp.csc_matrix, sp.csc_matrix]:
    G, H = igl.grad(target, F), igl.grad(V, F)
    return G.T @ G, G.T @ H


def meshes(V: np.ndarray, F: np.ndarray) -> None:
    target = V * [1.1, 0.9, 1.05] + np.sin(V[:, ::-1] / 30)
    corners, n = np.ascontiguousarray(F.T), len(V)
    assert np.abs(vertex_normals(V, F) - numpy_normals(V, F)).max() < 1e-12
    assert abs(cotangent_laplacian(V, F) - numpy_cotangents(V, F)).max() < 1e-9
    row("normals, checked", "libigl", lambda: vertex_normals(V, F), "numpy", lambda: numpy_normals(V, F))
    row(
        "cotangent Laplacian, checked",
        "libigl",
        lambda: cotangent_laplacian(V, F),
        "numpy, scipy.sparse",
        lambda: numpy_cotangents(V, F),
    )
    row(
        "vertex graph",
        "libigl",
        lambda: igl.adjacency_matrix(F),
        "scipy.sparse",
        lambda: scipy_adjacency(F, n),
    )
    ours, theirs = transfer_operators(V, target, corners), gradient_products(V, target, F)
    assert max(abs(a - b).max() for a, b in zip(ours, theirs, strict=False)) < 1e-9 * abs(ours[0]).max()
    row(
        "operators of deformation transfer",
        "by hand",
        lambda: transfer_operators(V, target, corners),
        "libigl's grad, two of three products",
        lambda: gradient_products(V, target, F),
    )
    row("components", "scipy.sparse", lambda: vertex_components(F, n), "libigl", lambda: igl.vertex_components(F))
    T = np.ascontiguousarray(deformation_gradients(V, F, target).transpose(1, 2, 0))
    stacked = np.ascontiguousarray(T.transpose(2, 0, 1))
    row(
        f"polar decomposition of {T.shape[2]} matrices",
        "by hand",
        lambda: polar_decomposition(T),
        "np.linalg.svd",
        lambda: np.linalg.svd(stacked),
    )


def pixels(V: np.ndarray, F: np.ndarray, size: int = 224) -> None:
    camera = ScaledOrthographicCamera.look(size=size, centre=(0, -25, -30), extent=300)
    points = np.column_stack([camera.project(V), camera.depth(V)])
    rows, columns = np.mgrid[:size, :size]
    starts = camera.unproject(np.column_stack([columns.ravel(), rows.ravel()]).astype(float), np.full(size**2, 500.0))
    towards = np.tile([0.0, 0.0, -1.0], (size**2, 1))
    tree = igl.AABB()
    tree.init(V, F)
    hit = tree.intersect_ray_first(V, F, starts, towards)[0].reshape(size, size)
    assert (hit != rasterize(points, F, size, size).face_ids).mean() < 0.02
    row(
        f"face ids and barycentrics {size}²",
        "OpenCV 5",
        lambda: rasterize(points, F, size, size),
        "rays of libigl's AABB",
        lambda: tree.intersect_ray_first(V, F, starts, towards),
    )


def files(path: Path) -> None:
    def theirs() -> trimesh.Scene:
        return trimesh.load_scene(path, process=False)

    count = sum(len(mesh.vertices) for mesh in theirs().geometry.values())
    row(
        f"OBJ of {len(read_obj(path).vertices)} vertices",
        "by hand",
        lambda: read_obj(path),
        f"trimesh: {count}",
        theirs,
    )


def pictures() -> None:
    rng = np.random.default_rng(0)
    img = rng.integers(0, 256, (512, 512, 3), dtype=np.uint8)
    mask = cv2.GaussianBlur(rng.random((512, 512)), (0, 0), 6) > 0.5
    plane, disc = img[:, :, 0].astype(np.float32), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (15, 15))
    angle = np.linspace(0, 6.28, 30)
    ring = 256 + np.stack([200 * np.cos(angle), 150 * np.sin(angle)], axis=1)
    lab = lambda: cv2.cvtColor(img.astype(np.float32) / 255, cv2.COLOR_RGB2LAB)  # noqa: E731
    fill = lambda: cv2.fillPoly(np.zeros((512, 512), np.uint8), [np.rint(16 * ring).astype(np.int32)], 1, shift=4)  # noqa: E731
    row("CIELAB of 512²", "OpenCV", lab, "scikit-image", lambda: color.rgb2lab(img))
    row("polygon in 512²", "OpenCV", fill, "scikit-image", lambda: draw.polygon2mask((512, 512), ring[:, ::-1]))
    byte = mask.astype(np.uint8)
    row("pieces of 512²", "OpenCV", lambda: cv2.connectedComponents(byte), "scikit-image", lambda: measure.label(mask))
    row(
        "Euclidean distance of 512²",
        "OpenCV",
        lambda: cv2.distanceTransform(byte, cv2.DIST_L2, 5),
        "scipy.ndimage, exact",
        lambda: ndimage.distance_transform_edt(mask),
    )
    row(
        "closing of 512² by 15",
        "OpenCV",
        lambda: cv2.morphologyEx(plane, cv2.MORPH_CLOSE, disc),
        "scikit-image",
        lambda: morphology.closing(plane, disc.astype(bool)),
    )
    M = np.array([[1.01, 0.1, 3], [-0.1, 1.02, 4], [0, 0, 1]])
    row(
        "affine warp of 512²",
        "OpenCV",
        lambda: cv2.warpAffine(img, M[:2], (512, 512)),
        "scikit-image",
        lambda: transform.warp(img, M),
    )

    def without_holes() -> np.ndarray:
        _, holes, stats, _ = cv2.connectedComponentsWithStats(1 - byte, connectivity=4)
        small = stats[:, cv2.CC_STAT_AREA] < 500
        small[0] = False
        return mask | small[holes]

    assert np.array_equal(without_holes(), morphology.remove_small_holes(mask, max_size=499))
    row(
        "small holes of 512²",
        "scikit-image",
        lambda: morphology.remove_small_holes(mask, max_size=499),
        "OpenCV",
        without_holes,
    )
    row(
        "distance in steps of 1024²",
        "scipy.ndimage",
        lambda: ndimage.distance_transform_cdt(np.tile(mask, (2, 2)), "taxicab"),
        "OpenCV",
        lambda: cv2.distanceTransform(np.tile(byte, (2, 2)), cv2.DIST_L1, 3),
    )


def main() -> None:
    model = default_model()
    V, F = np.ascontiguousarray(model.mean, np.float64), np.ascontiguousarray(model.faces, np.int64)
    print("| work | used | CPU ms | rival | its ms | ratio |\n|---|---|---|---|---|---|")
    meshes(V, F)
    pixels(V, F)
    pictures()
    if len(sys.argv) > 1:
        files(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "template.obj"
            write_obj(path, Scene((SceneMesh("head", V, F, uv=model.uv, uv_faces=model.uv_faces),)))
            files(path)


if __name__ == "__main__":
    main()
