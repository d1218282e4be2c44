"""A head of another topology: how well the template is laid on it, and what its 46 expressions lose there and back.

usage: python benchmarks/register.py ICT [--amberg]   (ICT: ict_facekit_light.npz of ICT-FaceKit)

Table 1: registrations of the template with the neutral head of ICT-FaceKit (11,248 vertices), which is turned, moved
and made smaller. Distances in percent of the distance of the outer eye corners: from the face of the template to the
head, from the face of the head to the template, and of the 51 inner landmarks; then triangles of the face that have
turned over against the similarity of the landmarks, and the CPU time. Rivals: every vertex on its closest point, after
ten rounds of ICP; and, with --amberg, `trimesh.registration.nricp_amberg` of the template's face.
Table 2: the template's expressions transferred to that head by `rig_mesh`, and from there back to the template. Error:
mean length of the difference over mean length of the motion, over the skin that the expression moves by more than a
tenth of its greatest motion there.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import dataclasses
import time

import igl
import numpy as np
from scipy.spatial.transform import Rotation

from toongeo import MorphableModel, default_model, nonrigid_register, rig_mesh
from toongeo.geometry.rotations.similarity import similarity
from toongeo.model.anatomy.hidden_vertices import hidden_vertices
from toongeo.model.ibug68 import INNER, OUTER_EYES
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit
from toongeo.pipeline.rig.foreign.register_face import register_face

SCALE, TURN, SHIFT = 0.37, Rotation.from_euler("xyz", [20, -50, 130], degrees=True).as_matrix(), np.array([5.0, 6, 7])
ICP_STEPS = 10


def moved(V: np.ndarray) -> np.ndarray:
    return SCALE * V @ TURN.T + SHIFT


def round_trip(template: MorphableModel, head: MorphableModel) -> np.ndarray:
    """The template's expressions (46, n, 3) as they come back from a head of another topology."""
    there = rig_mesh(moved(head.mean), head.faces, head.landmarks, model=template)
    rigged = dataclasses.replace(
        head,
        expression=(there.deltas @ TURN / SCALE).astype(np.float32),
        expression_names=there.names,
        n_named=len(there.names),
    )
    return rig_mesh(template.mean, template.faces, template.landmarks, model=rigged).deltas


def relative_errors(template: MorphableModel, returned: np.ndarray) -> np.ndarray:
    """Error (46,) of each expression on the skin; NaN where none of it moves, as for the tongue."""
    skin = template.region("skin") | template.region("neck")
    errors = np.full(len(returned), np.nan)
    for k, (shape, back) in enumerate(zip(template.expression, returned, strict=False)):
        motion = np.linalg.norm(shape, axis=1)
        moves = skin & (motion > 0.1 * motion[skin].max()) & (motion > 1e-3 * motion.max())
        if moves.any():
            errors[k] = np.linalg.norm(back - shape, axis=1)[moves].mean() / motion[moves].mean()
    return errors


def quality(
    V: np.ndarray, F: np.ndarray, aligned: np.ndarray, landmarks: np.ndarray, head: MorphableModel
) -> list[float]:
    """Distances there and back and of the landmarks (percent), triangles turned over."""
    target, points = moved(head.mean), moved(head.mean[head.landmarks[INNER]])
    eyes = np.linalg.norm(np.subtract(*moved(head.mean[head.landmarks[list(OUTER_EYES)]])))
    there = igl.point_mesh_squared_distance(V, target, head.faces)[0]
    narrow = target[head.region("narrow_face")]
    back = igl.point_mesh_squared_distance(narrow, V, F)[0]
    before, after = (np.cross(X[F[:, 1]] - X[F[:, 0]], X[F[:, 2]] - X[F[:, 0]]) for X in (aligned, V))
    return [
        *(100 * np.sqrt(squares).mean() / eyes for squares in (there, back)),
        100 * np.linalg.norm(V[landmarks] - points, axis=1).mean() / eyes,
        float(((before * after).sum(1) < 0).sum()),
    ]


def closest_points(V: np.ndarray, head: MorphableModel) -> np.ndarray:
    target = moved(head.mean)
    for _ in range(ICP_STEPS):
        closest = igl.point_mesh_squared_distance(V, target, head.faces)[2]
        scale, rotation, shift = similarity(V, closest)
        V = scale * V @ rotation.T + shift
    return igl.point_mesh_squared_distance(V, target, head.faces)[2]


def amberg(V: np.ndarray, F: np.ndarray, landmarks: np.ndarray, head: MorphableModel) -> np.ndarray:
    import trimesh
    from trimesh.registration import nricp_amberg

    source = trimesh.Trimesh(V, F, process=False)
    target = trimesh.Trimesh(moved(head.mean), head.faces, process=False)
    points = target.vertices[head.landmarks[INNER]]
    return nricp_amberg(source, target, source_landmarks=landmarks, target_positions=points, use_faces=True)


def registrations(template: MorphableModel, head: MorphableModel, with_amberg: bool) -> None:
    front = template.region("face")
    used, local = np.unique(template.faces[front[template.faces].all(1)], return_inverse=True)
    F = local.reshape(-1, 3)
    landmarks = np.searchsorted(used, template.landmarks[INNER])
    target, points = moved(head.mean), moved(head.mean[head.landmarks])
    scale, rotation, shift = similarity(template.mean[template.landmarks[INNER]], points[INNER])
    aligned = scale * template.mean[used] @ rotation.T + shift
    fitted = ~hidden_vertices(template)
    vertices = template.landmarks[INNER]
    ways = {
        "similarity of landmarks": lambda: aligned,
        "closest points after ICP (rival)": lambda: closest_points(aligned, head),
        "nonrigid_register": lambda: nonrigid_register(
            template.mean, template.faces, target, head.faces, vertices, points[INNER], fitted=fitted
        ).vertices[used],
        "with the rims of eyes and lips (`rig_mesh`)": lambda: register_face(
            target, head.faces, points, template
        ).registration.vertices[used],
    }
    if with_amberg:
        ways["trimesh nricp_amberg (face only)"] = lambda: amberg(aligned, F, landmarks, head)
    print("| registration | template to head, % | head to template, % | landmarks, % | turned over | CPU s |")
    print("|---|---|---|---|---|---|")
    for name, way in ways.items():
        started = time.process_time()
        V = way()
        seconds = time.process_time() - started
        there, back, marks, over = quality(V, F, aligned, landmarks, head)
        print(
            f"| {name} | {there:.3f} | {back:.3f} | {marks:.2f} | {over:.0f} of {len(F)} | {seconds:.1f} |", flush=True
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ict", help="ict_facekit_light.npz")
    parser.add_argument("--amberg", action="store_true", help="also trimesh's registration (minutes)")
    options = parser.parse_args()
    template, head = default_model(), load_ict_facekit(options.ict)
    registrations(template, head, options.amberg)
    started = time.process_time()
    returned = round_trip(template, head)
    print(f"\nThere and back: {time.process_time() - started:.1f} s CPU\n")
    errors = relative_errors(template, returned)
    print("| expression | error, % of its mean motion |")
    print("|---|---|")
    for k in np.argsort(-np.nan_to_num(errors)):
        shown = "does not move the skin" if np.isnan(errors[k]) else f"{100 * errors[k]:.1f}"
        print(f"| {template.expression_names[k]} | {shown} |")
    print(f"| mean / greatest | {100 * np.nanmean(errors):.1f} / {100 * np.nanmax(errors):.1f} |")


if __name__ == "__main__":
    main()
