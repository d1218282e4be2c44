"""The geometric kernels against named rivals, in one run on the default template (one BLAS thread).

usage: python benchmarks/kernels.py
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import time
from collections.abc import Callable

import cv2
import igl
import numpy as np
from pictures import FOLDER

from toongeo import (
    DeformationTransfer,
    LaplacianAligner,
    ScaledOrthographicCamera,
    default_model,
    deformation_transfer,
    diffuse_texture,
    fit_3dmm,
    laplacian_align,
    read_image,
    read_landmarks,
)
from toongeo.render import rasterize

PICTURE = FOLDER / "blue_girl.png"


def best(run: Callable[[], object], times: int) -> float:
    """Least seconds of several runs: what the machine's other work adds is no property of the code."""
    seconds = []
    for _ in range(times):
        started = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - started)
    return min(seconds)


def row(step: str, ours: float, rival: str, theirs: float) -> None:
    print(f"| {step} | {1000 * ours:.2f} | {rival} | {1000 * theirs:.1f} | {theirs / ours:.1f} |", flush=True)


def alignment(fit, landmarks: np.ndarray) -> None:
    # Without teeth and tongue: ARAP wants an anchor in every component.
    loose = np.any([fit.region(name) for name in ("teeth_upper", "teeth_lower", "tongue")], axis=0)
    kept = np.flatnonzero(~loose)
    V, F = fit.vertices[kept], np.searchsorted(kept, fit.faces[~loose[fit.faces].any(1)])
    vertices, first = np.unique(fit.landmark_vertices, return_index=True)
    targets = fit.camera.unproject(landmarks[first], fit.camera.depth(fit.vertices[vertices]))
    anchors = np.searchsorted(kept, vertices)

    def arap() -> None:
        data = igl.ARAPData()
        data.max_iter = 100
        igl.arap_precomputation(V, F, 3, anchors.astype(np.int32), data)
        igl.arap_solve(targets, data, V)

    rival = best(arap, 2)
    row(
        "align, new mesh",
        best(lambda: laplacian_align(V, F, anchors, targets), 5),
        "ARAP (libigl, 100 iterations)",
        rival,
    )
    aligner = LaplacianAligner(V, F, anchors)
    row(
        "align, same mesh and anchors", best(lambda: aligner.align(targets), 20), "ARAP (libigl, 100 iterations)", rival
    )


def transfer(fit) -> None:
    model = fit.model
    shapes = model.mean + model.expression[: model.n_named]

    def ours() -> None:
        DeformationTransfer(model.mean, model.faces, fit.vertices).transfer(shapes)

    def one_by_one() -> None:
        for shape in shapes[:4]:
            deformation_transfer(model.mean, shape, model.faces, fit.vertices)

    rival = best(one_by_one, 1) * len(shapes) / 4
    row("transfer of 46 expressions", best(ours, 3), "46 factorizations (4 measured)", rival)


def diffusion() -> None:
    rows, columns = np.mgrid[:1024, :1024]
    mask = ((columns - 512) / 380) ** 2 + ((rows - 520) / 450) ** 2 < 1
    img = np.random.default_rng(0).integers(0, 256, (1024, 1024, 3)).astype(np.uint8)
    ours = best(lambda: diffuse_texture(img, mask), 5)
    theirs = best(lambda: diffuse_texture(img, mask, order="sequential"), 1)
    row(f"BFS diffusion 1024², {100 * (~mask).mean():.0f} % unknown", ours, "queue in Python", theirs)


def z_buffer(points: np.ndarray, F: np.ndarray, size: int) -> np.ndarray:
    """A plain z-buffer in numpy: every candidate pixel of every triangle's box, nearest by np.minimum.at."""
    p = points[F]
    low = np.clip(np.ceil(p[:, :, :2].min(1)), 0, size).astype(int)
    high = np.clip(np.floor(p[:, :, :2].max(1)) + 1, 0, size).astype(int)
    extent = np.maximum(high - low, 0)
    count = extent.prod(1)
    face = np.repeat(np.arange(len(F)), count)
    step = np.arange(len(face)) - np.repeat(np.cumsum(count) - count, count)
    x, y = low[face, 0] + step % extent[face, 0], low[face, 1] + step // extent[face, 0]
    a, u, v = p[face, 0], p[face, 1] - p[face, 0], p[face, 2] - p[face, 0]
    det = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    det[det == 0] = np.inf
    s = ((x - a[:, 0]) * v[:, 1] - (y - a[:, 1]) * v[:, 0]) / det
    t = (u[:, 0] * (y - a[:, 1]) - u[:, 1] * (x - a[:, 0])) / det
    inside = (s >= 0) & (t >= 0) & (s + t <= 1)
    depth = (a[:, 2] + s * u[:, 2] + t * v[:, 2])[inside]
    key = ((points[:, 2].max() - depth) * 1e6).astype(np.int64) * 2**24 + face[inside]
    buffer = np.full(size * size, np.iinfo(np.int64).max)
    np.minimum.at(buffer, y[inside] * size + x[inside], key)
    return np.where(buffer < np.iinfo(np.int64).max, buffer % 2**24, -1).reshape(size, size)


def rasterization(model) -> None:
    for size in (224, 512, 1024):
        camera = ScaledOrthographicCamera.look(size=size, centre=(0, -25, -30), extent=300)
        points = np.column_stack([camera.project(model.mean), camera.depth(model.mean)])
        ours, theirs = rasterize(points, model.faces, size, size).face_ids, z_buffer(points, model.faces, size)
        assert (ours != theirs).mean() < 2e-3
        rival = best(lambda points=points, size=size: z_buffer(points, model.faces, size), 3)
        ours_s = best(lambda points=points, size=size: rasterize(points, model.faces, size, size), 5)
        row(f"face ids and barycentrics {size}²", ours_s, "numpy z-buffer, ids only", rival)
        fast = cv2.triangleRasterizeColor
        del cv2.triangleRasterizeColor  # as with OpenCV 4
        ours_s = best(lambda points=points, size=size: rasterize(points, model.faces, size, size), 3)
        cv2.triangleRasterizeColor = fast
        row(f"the same without OpenCV 5, {size}²", ours_s, "numpy z-buffer, ids only", rival)


def main() -> None:
    model = default_model()
    landmarks = read_landmarks(PICTURE.with_suffix(".pts"))
    fit = fit_3dmm(read_image(PICTURE), landmarks)
    print("| step | ms | rival | rival ms | ratio |\n|---|---|---|---|---|")
    alignment(fit, landmarks)
    transfer(fit)
    diffusion()
    rasterization(model)


if __name__ == "__main__":
    main()
