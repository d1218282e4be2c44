"""Contacts between lids and eyeballs on the bundled examples, or on other pictures.

usage: python benchmarks/contacts.py [FOLDER ...]
(pictures with .pts or .txt beside them; default: the bundled examples)

shows: most of an eyeball's disc that is seen at `eyeBlink*` = 1, yaw 0 and +-30 degrees, percent. gap: of the lids'
edges from the eyeball in the neutral face, percent of its radius, mean and greatest. inside: skin vertices inside an
eyeball, over the neutral face, all expressions and the gaze; half: the same for lids at a quarter, a half and three
quarters of the blinks. neutral: triangles of the region `face` that intersect others since the lids were laid onto the
eyeballs. crossing: the same in an expression, less those of the neutral face and of the template for this expression,
worst of those that move the eyes; allowed are 0.1 % of the triangles. closed: percent of the opening. seconds: CPU
time of the contacts of the lids and of the mouth, and of the neutral face with the transfer before them.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import time

import numpy as np
from pictures import Picture, pictures, roles

from toongeo import align_face, build_rig, fit_3dmm, fit_lids, fit_mouth, neutral_face, read_image, read_landmarks
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rims import opening_rim, rim_path
from toongeo.pipeline import AlignedFace, Eyes, Rig
from toongeo.pipeline.rig.eyes.visible_eyeballs import visible_eyeballs

BLINK = {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
AROUND_EYES = ("brow", "cheekSquint", "eye", "mouthSmile", "noseSneer")


def gaps(face: AlignedFace, rig: Rig, eyes: Eyes) -> np.ndarray:
    """Distances of the lids' edges from their eyeballs, percent of the radius."""
    out = []
    for side, name in enumerate(SIDES):
        paths = (rim_path(face.model, f"lid_{lid}_{name}") for lid in ("upper", "lower"))
        rim = np.unique(np.r_[opening_rim(face.model, f"socket_{name}"), *paths])
        out.append(np.linalg.norm(rig.neutral[rim] - eyes.centres[side], axis=1) / eyes.radii[side] - 1)
    return 100 * np.concatenate(out)


def inside(points: np.ndarray, eyes: Eyes) -> int:
    return sum(
        int((np.linalg.norm(points - c, axis=1) < r).sum()) for c, r in zip(eyes.centres, eyes.radii, strict=True)
    )


def crossing(face: AlignedFace, rig: Rig, drawn: np.ndarray) -> tuple[int, int, str]:
    """Triangles by which the neutral face exceeds the drawn one; the most by which an expression does, and its name.

    An expression is compared with the better of the two, so that a worse neutral face makes nothing better.
    """
    F = face.faces[face.region("face")[face.faces].all(1)]
    model = face.model

    def count(V: np.ndarray) -> int:
        return len(mesh_quality(V, F).intersecting)

    gained, neutral = count(rig.neutral) - count(drawn), min(count(rig.neutral), count(drawn))
    worst = (0, "-")
    for name in (*rig.names, *GAZE_NAMES):
        if name.startswith(AROUND_EYES):
            excess = count(rig.vertices({name: 1.0})) - neutral
            if excess > worst[0] and name in rig.names:
                excess -= count(model.mean + model.expression[model.expression_index(name)])
            worst = max(worst, (excess, name))
    return gained, *worst


def row(picture: Picture) -> list[object]:
    landmarks = read_landmarks(picture.landmarks)
    face = align_face(fit_3dmm(read_image(picture.image), landmarks), landmarks)
    times = [time.process_time()]
    face = neutral_face(face)
    rig = build_rig(face)
    times.append(time.process_time())
    rig = fit_mouth(face, rig)
    times.append(time.process_time())
    drawn = rig.neutral
    rig, eyes = fit_lids(face, rig)
    times.append(time.process_time())
    shown = [100 * visible_eyeballs(face, rig, eyes, BLINK, yaw=yaw) for yaw in (-30, 0, 30)]
    gap, skin = gaps(face, rig, eyes), face.region("skin")
    lids = np.any([face.region(f"eyelid_{lid}_{name}") for lid in ("upper", "lower") for name in SIDES], axis=0)
    within = sum(inside((rig.neutral + shape)[skin], eyes) for shape in (0, *rig.deltas, *rig.gaze))
    half = sum(inside(rig.vertices(dict.fromkeys(BLINK, w))[lids], eyes) for w in (0.25, 0.5, 0.75))
    closed = min(rig.report.closure_left, rig.report.closure_right)
    gained, excess, name = crossing(face, rig, drawn)
    seconds = np.diff(times)
    return [np.max(shown), gap.mean(), gap.max(), within, half, gained, excess, closed, *seconds[::-1], name]


def main() -> None:
    found = pictures(sys.argv[1:])
    print(
        f"{'':<26} shows   gap mean  max  inside half neutral crossing closed   lids    mouth  transfer"
        "  worst expression"
    )
    for picture in found:
        shown, mean, most, within, half, gained, excess, closed, *seconds, name = row(picture)
        print(
            f"{picture.name:<26} {shown:5.2f}   {mean:8.1f} {most:4.1f}  {within:6d} {half:4d} {gained:+7d}"
            f" {excess:8d} {closed:6.1f}  {seconds[0]:5.2f} s {seconds[1]:5.2f} s {seconds[2]:6.2f} s  {name}",
            flush=True,
        )
    print(roles("contacts", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
