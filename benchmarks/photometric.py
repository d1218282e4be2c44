"""Photometric fit: recovery of rendered faces, residuals on pictures, time and memory.

usage: python benchmarks/photometric.py [FOLDER ...]   (pictures with .pts beside them; default: the bundled examples)
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import resource
import sys
import time
from pathlib import Path

import cv2
import numpy as np

from toongeo import ScaledOrthographicCamera, default_model, fit_3dmm, photometric_fit, read_image, read_landmarks
from toongeo.geometry import vertex_normals
from toongeo.pipeline.fit.contour import visible_landmarks
from toongeo.pipeline.fit.landmark_basis import landmark_basis
from toongeo.render import Surface, irradiance, render_mesh, sh_basis, srgb_to_linear

PORTRAITS = Path(__file__).parents[1] / "examples" / "portraits"
SUBJECTS = range(10)
SIZE = 512


def rendered_subject(model, seed):
    """Picture, noisy landmarks and truth of a random face under a random light."""
    rng = np.random.default_rng(seed)
    identity = 0.6 * rng.standard_normal(len(model.identity))
    expression = np.zeros(len(model.expression))
    expression[rng.choice(model.n_named, 3, replace=False)] = rng.uniform(0.1, 0.5, 3)
    expression[model.expression_index("mouthClose")] = 0
    albedo = 0.7 * rng.standard_normal(len(model.albedo))
    camera = ScaledOrthographicCamera.look(*rng.uniform([-30, -10, -10], [30, 10, 10]), size=SIZE)
    light = random_light(rng)
    vertices = model.vertices(identity, expression)
    colours = np.clip(model.albedo_mean + np.tensordot(albedo, model.albedo, 1), 0, 1)
    picture = render_mesh(Surface(vertices, model.faces, colours=colours), camera, SIZE, light=light)
    placed = visible_landmarks(landmark_basis(model), np.concatenate([identity, expression]), camera.rotation)
    landmarks = camera.project(vertices[placed]) + rng.normal(0, 1, (68, 2))
    return picture, landmarks, (vertices, camera, albedo, light)


def random_light(rng):
    """Ambient light and two lamps from the front hemisphere, each a little coloured."""
    light = np.zeros((9, 3))
    light[0] = np.sqrt(4 * np.pi) * 0.35
    for strength in (0.5, 0.25):
        towards = rng.normal(size=3)
        towards[2] = abs(towards[2]) + 0.5
        colour = strength * rng.uniform(0.8, 1.2, 3)
        light += np.pi * colour * sh_basis(towards[None] / np.linalg.norm(towards)).T
    return light


def face_error(found, truth):
    """Mean distance of corresponding points (k, 3) after the best similarity, mm."""
    a, b = found - found.mean(0), truth - truth.mean(0)
    U, s, Vt = np.linalg.svd(b.T @ a)
    D = np.diag([1, 1, np.sign(np.linalg.det(U @ Vt))])
    scale = (s * np.diag(D)).sum() / (a**2).sum()
    return float(np.linalg.norm(scale * a @ (U @ D @ Vt).T - b, axis=1).mean())


def appearance(model, vertices, camera, albedo, light):
    """Albedo and shaded albedo (n, 3) of the vertices, linear light."""
    reflectance = srgb_to_linear(model.albedo_mean + np.tensordot(albedo, model.albedo, 1))
    shade = irradiance(vertex_normals(vertices, model.faces) @ camera.rotation.T, light) / np.pi
    return reflectance, reflectance * shade


def recovery():
    model = default_model()
    face = model.region("face")
    print("| subject | shape, landmarks mm | with photometric mm | shading x albedo % | albedo after gain % |")
    print("|---|---|---|---|---|")
    rows = []
    for seed in SUBJECTS:
        picture, landmarks, (vertices, camera, albedo, light) = rendered_subject(model, seed)
        fit = fit_3dmm(picture, landmarks)
        refined = photometric_fit(picture, fit, landmarks)
        seen = face & ((vertex_normals(vertices, model.faces) @ camera.rotation.T)[:, 2] > 0.2)
        true_albedo, true_shaded = (a[seen] for a in appearance(model, vertices, camera, albedo, light))
        found = appearance(model, refined.vertices, refined.camera, refined.albedo, refined.light)
        found_albedo, found_shaded = (a[seen] for a in found)
        gain = (found_albedo * true_albedo).sum(0) / (found_albedo**2).sum(0)
        rows.append(
            [
                face_error(fit.vertices[face], vertices[face]),
                face_error(refined.vertices[face], vertices[face]),
                100 * np.sqrt(((found_shaded - true_shaded) ** 2).mean() / (true_shaded**2).mean()),
                100 * np.sqrt(((gain * found_albedo - true_albedo) ** 2).mean() / (true_albedo**2).mean()),
            ]
        )
        print(f"| {seed} | " + " | ".join(f"{value:.2f}" for value in rows[-1]) + " |")
    print("| mean | " + " | ".join(f"{value:.2f}" for value in np.mean(rows, axis=0)) + " |")


def pictures(folders):
    print("\n| picture | residual before % | after % | ratio | of squares | confident % | s at 1024 px |")
    print("|---|---|---|---|---|---|---|")
    for folder in folders:
        for points in sorted(folder.glob("*.pts")):
            path = next(path for path in sorted(folder.glob(f"{points.stem}.*")) if path.suffix != ".pts")
            img, landmarks = read_image(path), read_landmarks(points)
            report = photometric_fit(img, fit_3dmm(img, landmarks), landmarks).photometric
            before, after = 100 * report.residual_before, 100 * report.residual_after
            print(
                f"| {points.stem} | {before:.1f} | {after:.1f} | {after / before:.2f} | {(after / before) ** 2:.2f} "
                f"| {100 * report.confident_fraction:.0f} | {seconds_at_1024(img, landmarks):.3f} |"
            )


def seconds_at_1024(img, landmarks):
    """Best of three, landmarks included, of the picture resized to 1024 px."""
    factor = 1024 / max(img.shape)
    large = cv2.resize(img, None, fx=factor, fy=factor, interpolation=cv2.INTER_CUBIC)
    points = (landmarks + 0.5) * factor - 0.5
    times = []
    for _ in range(3):
        started = time.perf_counter()
        photometric_fit(large, fit_3dmm(large, points), points)
        times.append(time.perf_counter() - started)
    return min(times)


def main():
    recovery()
    pictures([Path(name) for name in sys.argv[1:]] or [PORTRAITS])
    print(f"\nlargest memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
