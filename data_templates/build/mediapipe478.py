"""Rebuild mediapipe478.csv: which point of MediaPipe's face mesh each iBUG-68 point is.

usage: python data_templates/build/mediapipe478.py canonical_face_model.obj [-o data_templates/mediapipe478.csv]

The mesh is mediapipe/modules/face_geometry/data/canonical_face_model.obj of MediaPipe (Apache License 2.0), whose
vertex numbers are those of the landmarks; mind copies that a 3D program has written anew, in another order. Only the
indices chosen here travel with the project.

The mesh is laid on the mean of the template by the similarity of seven points that both schemes define alike: eye
corners, mouth corners, tip of the nose. Then each iBUG point takes a vertex of the chain that
mediapipe_curves.csv gives it.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.model import default_model
from toongeo.model.ibug68 import MIRROR, NAMES

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CURVES = Path(__file__).with_name("mediapipe_curves.csv")
N_MESH = 468
ANCHORS = {36: 33, 39: 133, 42: 362, 45: 263, 48: 61, 54: 291, 30: 4}  # iBUG point -> vertex
HEAD = """\
# MediaPipe's face mesh (468 points, or 478 with the irises, which are not used) as iBUG-68 points.
# Derived by build/mediapipe478.py: the canonical face mesh is laid on the mean of the template by a similarity, and
# each point takes a vertex of the chain in note. distance_mm: how far it then lies from the template's landmark.
# Points 0-16 differ much, because MediaPipe's face oval runs in front of the outline that iBUG's annotators follow.
"""


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", type=Path, help="canonical_face_model.obj")
    parser.add_argument("-o", "--output", default=Path(__file__).parents[1] / "mediapipe478.csv", type=Path)
    arguments = parser.parse_args()
    model = default_model()
    landmarks = model.mean[model.landmarks]
    mesh = aligned(mesh_vertices(arguments.mesh), landmarks)
    write_table(arguments.output, *chosen(mesh, landmarks), mesh, landmarks)


def mesh_vertices(path: Path) -> Floats:
    """Vertices (468, 3) of an OBJ file, in its order."""
    lines = path.read_text(encoding="utf-8").splitlines()
    V = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], np.float64)
    if V.shape != (N_MESH, 3):
        raise ValueError(f"mesh: expected {N_MESH} vertices in {path}, got {len(V)}")
    if V[:, 2].argmax() != ANCHORS[30]:
        raise ValueError(f"mesh: expected vertex {ANCHORS[30]} of {path} to protrude most, got {V[:, 2].argmax()}")
    return V


def aligned(mesh: Floats, landmarks: Floats) -> Floats:
    """The mesh (n, 3) moved by the similarity (Umeyama 1991) that lays its anchors on our landmarks (68, 3)."""
    source, target = mesh[list(ANCHORS.values())], landmarks[list(ANCHORS)]
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    U, s, Vt = np.linalg.svd(b.T @ a)
    s[2] *= np.linalg.det(U @ Vt)
    U[:, 2] *= np.linalg.det(U @ Vt)
    return (mesh - source.mean(axis=0)) @ (U @ Vt).T * (s.sum() / (a**2).sum()) + target.mean(axis=0)


def chosen(mesh: Floats, landmarks: Floats) -> tuple[Ints, list[str]]:
    """Vertex of each point (68,), and what the chain it comes from is."""
    other = np.array([np.linalg.norm(mesh - v * [-1, 1, 1], axis=1).argmin() for v in mesh])
    vertices, notes = np.full(68, -1), [""] * 68
    with CURVES.open(encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            points, chain = (np.array(row[key].split(), int) for key in ("points", "vertices"))
            if row["rule"] == "share":
                gaps = np.abs(shares(landmarks[points])[:, None] - shares(mesh[chain]))
            else:
                gaps = np.linalg.norm(landmarks[points][:, None] - mesh[chain], axis=2)
            picked = gaps.argmin(axis=1)
            if not (np.diff(picked) > 0).all():
                raise ValueError(f"mesh: expected points {points} in the order of chain {chain}, got {chain[picked]}")
            for k, vertex in zip(points, chain[picked], strict=True):
                vertices[k], notes[k] = vertex, row["note"]
                if MIRROR[k] != k:
                    vertices[MIRROR[k]], notes[MIRROR[k]] = other[vertex], row["note"].replace("right", "left")
    return vertices, notes


def shares(points: Floats) -> Floats:
    """Share (k,) of the length of a chain (k, 3), seen from in front, up to each of its points."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1))]
    return length / length[-1]


def write_table(path: Path, vertices: Ints, notes: list[str], mesh: Floats, landmarks: Floats) -> None:
    """The table, a row a point."""
    distances = np.linalg.norm(mesh[vertices] - landmarks, axis=1)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(HEAD)
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["index", "name", "vertex", "distance_mm", "note"])
        for k, name in enumerate(NAMES):
            rows.writerow([k, name, vertices[k], f"{distances[k]:.1f}", notes[k]])


if __name__ == "__main__":
    main()
