"""Lips that seal and do not cross, teeth that stay inside: one table over pictures.

``python benchmarks/lips.py FOLDER ...`` for folders of pictures with landmarks of the same name (.pts or .txt);
without a folder the bundled examples are used. Before and after :func:`toongeo.pipeline.fit_mouth`:

- seal: distance between the lines where the lips end, with ``mouthClose`` and ``jawOpen`` at 1, in % of the mouth's
  width, from dense points of either line to the nearest of the other (mean and max, in space), and the largest height
  of the slit as seen from the front.
- crossings: expressions at 1 in which a point of one line lies beyond the other, seen from the front, by more than
  0.3 % of the mouth's width, where it does not in the aligned face.
- intersecting: expressions of the mouth whose `face` self-intersections exceed those of the neutral face plus the
  template's own by more than 0.1 percentage points, and by how many. ``mouthClose`` is a corrective of ``jawOpen`` and
  is shown both with it (``+jawOpen``) and alone.
- teeth outside: vertices of teeth, gums and tongue before the skin, over all these expressions but the tongue of
  ``tongueOut``.
- seconds: of CPU, best of three.
"""

import sys
import time
from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from pictures import pictures, roles
from scipy.spatial import cKDTree

from toongeo.io import read_landmarks
from toongeo.metrics import mesh_quality
from toongeo.model import MorphableModel, default_model
from toongeo.model.anatomy.lip_line import lip_line
from toongeo.pipeline import AlignedFace, Rig, align_face, build_rig, fit_3dmm, fit_mouth, neutral_face
from toongeo.pipeline.align.keep_teeth_inside import enclosed

MOUTH = ("mouth", "jaw", "cheekPuff", "nose", "tongue")
PARTS = ("teeth_upper", "teeth_lower", "tongue")
ALLOWED = 0.1  # percentage points
CROSSING = 0.3  # % of the mouth's width
EVERY = 3  # every so manieth vertex of the teeth is looked at
BOTH = "mouthClose+jawOpen"


def shapes(names: tuple[str, ...], neutral: np.ndarray, deltas: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """The expressions of the mouth at 1."""
    for name, delta in zip(names, deltas, strict=True):
        if name.startswith(MOUTH):
            yield name, neutral + delta
    yield BOTH, neutral + deltas[names.index("mouthClose")] + deltas[names.index("jawOpen")]


def intersecting(model: MorphableModel, V: np.ndarray) -> float:
    """Share of the triangles of the face that intersect others, in %."""
    used, F = np.unique(model.faces[model.region("face")[model.faces].all(1)], return_inverse=True)
    return 100 * mesh_quality(V[used], F.reshape(-1, 3)).intersecting_fraction


@lru_cache(maxsize=1)
def own() -> dict[str, float]:
    """Self-intersections of the template's own expressions."""
    model = default_model()
    named = model.expression_names[: model.n_named], model.mean, model.expression[: model.n_named]
    return {name: intersecting(model, V) for name, V in shapes(*named)}


def dense(path: np.ndarray) -> np.ndarray:
    """Points (j, 3) close together on a path of points (k, 3)."""
    steps = np.linspace(0, 1, 20, endpoint=False)[:, None, None]
    return np.vstack([(path[:-1] + steps * np.diff(path, axis=0)).reshape(-1, 3), path[-1:]])


def heights(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """How far the upper line is above the lower one at the same place along the mouth, in % of its width."""
    line = lip_line(model)
    upper, lower = V[line.upper], V[line.lower]
    width = np.linalg.norm(upper[-1] - upper[0])
    axis = (upper[-1] - upper[0]) / width
    up = np.array([0.0, 1.0, 0.0]) - axis[1] * axis
    low = lower[np.argsort(lower @ axis, kind="stable")]
    return 100 / width * (upper @ up - np.interp(upper @ axis, low @ axis, low @ up))


def seal(model: MorphableModel, V: np.ndarray) -> tuple[float, float, float]:
    """Mean and largest distance of the lines, and the largest height of the slit, in % of the mouth's width."""
    line = lip_line(model)
    upper, lower = dense(V[line.upper]), dense(V[line.lower])
    distances = np.r_[cKDTree(upper).query(lower)[0], cKDTree(lower).query(upper)[0]]
    distances *= 100 / np.linalg.norm(upper[-1] - upper[0])
    return float(distances.mean()), float(distances.max()), float(heights(model, V).max())


def outside(model: MorphableModel, name: str, V: np.ndarray) -> int:
    held = np.any([model.region(part) for part in PARTS if (part, name) != ("tongue", "tongueOut")], axis=0)
    return int((~enclosed(model, V, V[held][::EVERY])).sum())


def measured(face: AlignedFace, rig: Rig) -> tuple[list[float], list[str], list[str], int]:
    """The seal, what crosses, what intersects above the allowance, and teeth outside."""
    model = face.model
    neutral = intersecting(model, rig.neutral)
    order = np.minimum(heights(model, face.vertices), 0)
    crossings, excess, teeth = [], [], outside(model, "neutral", rig.neutral)
    for name, V in shapes(rig.names, rig.neutral, rig.deltas):
        if name != "mouthClose":
            beyond = (order - heights(model, V)).max()
            crossings += [f"{name} {beyond:.1f}"] if beyond > CROSSING else []
            teeth += outside(model, name, V)
        more = intersecting(model, V) - neutral - own()[name] - ALLOWED
        excess += [f"{name} {more:.2f}"] if more > 0 else []
    return list(seal(model, V)), crossings, excess, teeth


def row(gaps: list[float], crossings: list[str], excess: list[str], teeth: int) -> str:
    told = " / ".join(f"{gap:.2f}" for gap in gaps)
    return " | ".join([told, ", ".join(crossings) or "-", ", ".join(excess) or "-", str(teeth)])


def summary(title: str, rows: list[tuple[list[float], list[str], list[str], int]]) -> str:
    gaps = np.array([gaps for gaps, *_ in rows])
    counts = (sum(bool(row[k]) for row in rows) for k in (1, 2, 3))
    told = " | ".join(f"{count} of {len(rows)}" for count in counts)
    return f"| {title} | {gaps[:, 0].max():.2f} | {gaps[:, 1].max():.2f} | {told} |"


def seconds(face: AlignedFace, rig: Rig) -> float:
    taken = []
    for _ in range(3):
        started = time.process_time()
        fit_mouth(face, rig)
        taken.append(time.process_time() - started)
    return min(taken)


def main() -> None:
    found = pictures(sys.argv[1:])
    print("| picture | rig | seal mean / max / front, % | crossings, % | intersecting above allowance | teeth | s |")
    print("|---|---|---|---|---|---|---|")
    ways: dict[str, list[tuple[list[float], list[str], list[str], int]]] = {"transferred": [], "fitted": []}
    for picture in found:
        landmarks = read_landmarks(picture.landmarks)
        face = neutral_face(align_face(fit_3dmm(None, landmarks), landmarks))
        plain = build_rig(face)
        rig = fit_mouth(face, plain)
        ways["transferred"].append(measured(face, plain))
        ways["fitted"].append(measured(face, rig))
        print(f"| {picture.name} | transferred |", row(*ways["transferred"][-1]), "| |")
        print("| | fitted |", row(*ways["fitted"][-1]), f"| {seconds(face, rig):.2f} |", flush=True)
    print("\n| rig | seal, worst mean % | worst of all % | pictures with lips that cross ", end="")
    print("| with intersections above the allowance | with teeth outside |\n|---|---|---|---|---|---|")
    for title, rows in ways.items():
        print(summary(title, rows))
    print(roles("lips", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
