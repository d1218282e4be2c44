"""Photometric fit: recovery of rendered faces, residuals on pictures, time and memory.

usage: python benchmarks/photometric.py [FOLDER ...]   (pictures with .pts beside them; default: the bundled examples)
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import resource
import sys
import time
from dataclasses import replace

import cv2
import numpy as np
from pictures import Picture, pictures, roles

from toongeo import ScaledOrthographicCamera, default_model, fit_3dmm, photometric_fit, read_image, read_landmarks
from toongeo.geometry import vertex_normals
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.render import Surface, interpolate, irradiance, rasterize, render_mesh, sh_basis, srgb_to_linear

SUBJECTS = range(10)
SIZE, NOISE = 512, 1.0  # px


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
    landmarks = camera.project(vertices[placed]) + NOISE * rng.normal(size=(68, 2))
    found = fit_3dmm(None, landmarks)
    truth = replace(found, identity=identity, expression=expression, camera=camera, albedo=albedo, light=light)
    return picture, landmarks, truth


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


def shaded(fit):
    """Albedo (n, 3) of the vertices and, pixel by pixel, shading times albedo of the front of the face, linear light.

    NaN where the face is not.
    """
    reflectance = srgb_to_linear(fit.model.albedo_mean + np.tensordot(fit.albedo, fit.model.albedo, 1))
    front = fit.faces[fit.region("face")[fit.faces].all(1)]
    normals = vertex_normals(fit.vertices, fit.faces) @ fit.camera.rotation.T
    points = np.column_stack([fit.project(fit.vertices), fit.camera.depth(fit.vertices)])
    fragments = rasterize(points, front, SIZE, SIZE)
    product = interpolate(fragments, front, reflectance * irradiance(normals, fit.light) / np.pi)
    product[~fragments.mask] = np.nan
    return reflectance, product


def recovery():
    model = default_model()
    face = model.region("face")
    print("| subject | shape, landmarks mm | with photometric mm | shading x albedo % | albedo after gain % |")
    print("|---|---|---|---|---|")
    rows = []
    for seed in SUBJECTS:
        picture, landmarks, truth = rendered_subject(model, seed)
        fit = fit_3dmm(picture, landmarks)
        refined = photometric_fit(picture, fit, landmarks)
        (true_albedo, true_product), (albedo, product) = shaded(truth), shaded(refined)
        both = np.isfinite(true_product + product)
        error = product[both] - true_product[both]
        albedo, true_albedo = albedo[face], true_albedo[face]
        gain = (albedo * true_albedo).sum(0) / (albedo**2).sum(0)
        rows.append(
            [
                face_error(fit.vertices[face], truth.vertices[face]),
                face_error(refined.vertices[face], truth.vertices[face]),
                100 * np.sqrt((error**2).mean() / (true_product[both] ** 2).mean()),
                100 * np.sqrt(((gain * albedo - true_albedo) ** 2).mean() / (true_albedo**2).mean()),
            ]
        )
        print(f"| {seed} | " + " | ".join(f"{value:.2f}" for value in rows[-1]) + " |")
    print("| mean | " + " | ".join(f"{value:.2f}" for value in np.mean(rows, axis=0)) + " |")
    print("\nWeights were chosen on seeds 20-29; these are only looked at.")


def picture_rows(found: list[Picture]):
    print(
        "\n| picture | ambient % | lit % | fitted % | L_photo, fitted / ambient | / lit | confident % | s at 1024 px |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for picture in found:
        img, landmarks = read_image(picture.image), read_landmarks(picture.landmarks)
        report = photometric_fit(img, fit_3dmm(img, landmarks), landmarks).photometric
        values = [report.residual_ambient, report.residual_before, report.residual_after]
        ambient, lit, fitted = (100 * value for value in values)
        print(
            f"| {picture.name} | {ambient:.1f} | {lit:.1f} | {fitted:.1f} "
            f"| {(fitted / ambient) ** 2:.2f} | {(fitted / lit) ** 2:.2f} "
            f"| {100 * report.confident_fraction:.0f} | {seconds_at_1024(img, landmarks):.3f} |",
            flush=True,
        )
    print(roles("photometric", [picture.name for picture in found]))


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
    picture_rows(pictures(sys.argv[1:]))
    print(f"\nlargest memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


if __name__ == "__main__":
    main()
