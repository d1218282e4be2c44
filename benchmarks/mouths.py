"""Mouths that are drawn open: closed at rest, and as in the picture in its pose.

``python benchmarks/mouths.py FOLDER ...`` for folders of pictures with landmarks of the same name (.pts or .txt);
without a folder the bundled examples are used. Pictures whose mouths are closed only have the column `lids`. The rival,
before the slash, takes the expression that the fit found out of the face by inverse deformation transfer, which
:func:`toongeo.neutral_face` does for models that do not tell where lips end; its rig is transferred as published.

- apart: mean distance of the lips in the picture and at rest, % of the mouth's width.
- crossing: triangles of the region `face` that intersect others in the picture; at rest; with the jaw open; smiling; in
  the picture's pose. The last three without those at rest.
- misses: of the picture's face by its pose, rms over the region `mouth`, % of the mouth's width.
- lids: how far an opening jaw moves the landmarks of the lids, % of the opening of the eye, worst of both.
- teeth: pixels of drawn teeth that show teeth in the picture's pose, and pixels beside them that do not, %.
"""

import dataclasses
import sys

import numpy as np
from pictures import Picture, pictures, roles

from toongeo import align_face, build_rig, fit_3dmm, fit_mouth, neutral_face, parse_face, read_image, read_landmarks
from toongeo.geometry import DeformationTransfer
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.lips_apart import lips_apart
from toongeo.model.anatomy.still_vertices import still_vertices
from toongeo.pipeline import AlignedFace, Rig
from toongeo.pipeline.align.size_teeth import size_teeth
from toongeo.pipeline.parse.drawn_mouth import DrawnMouth, drawn_mouth
from toongeo.pipeline.rig.fit_pose import fit_pose
from toongeo.render import rasterize

OPEN = 0.03  # of the mouth's width
SMILE = ("mouthSmileLeft", "mouthSmileRight")
LIDS = ((range(36, 42), ((37, 41), (38, 40))), (range(42, 48), ((43, 47), (44, 46))))


def crossing(face: AlignedFace, V: np.ndarray) -> int:
    return len(mesh_quality(V, face.faces[face.region("face")[face.faces].all(1)]).intersecting)


def removed(face: AlignedFace) -> AlignedFace:
    """The face at rest as the rival has it."""
    regions = {name: mask for name, mask in face.model.regions.items() if name != "mouth_cavity"}
    bare = dataclasses.replace(face, model=dataclasses.replace(face.model, regions=regions))
    return dataclasses.replace(neutral_face(bare), model=face.model)


def transferred(face: AlignedFace) -> Rig:
    """The rig as published: gradients carried over, and nothing else."""
    rig, model = build_rig(face), face.model
    transfer = DeformationTransfer(model.mean, model.faces, face.vertices, pinned=still_vertices(model), align=True)
    shapes = model.mean + model.expression[: len(rig.names)].astype(float)
    return dataclasses.replace(rig, deltas=(transfer(shapes) - face.vertices).astype(np.float32))


def lids_moved(face: AlignedFace, rig: Rig) -> float:
    at, jaw = face.model.landmarks, rig.deltas[rig.names.index("jawOpen")]
    worst = 0.0
    for lids, pairs in LIDS:
        opening = np.mean([np.linalg.norm(rig.neutral[at[a]] - rig.neutral[at[b]]) for a, b in pairs])
        worst = max(worst, 100 * float(np.linalg.norm(jaw[at[list(lids)]], axis=1).max() / opening))
    return worst


def shown(face: AlignedFace, rig: Rig, pose: np.ndarray, mouth: DrawnMouth) -> tuple[float, float]:
    """Shares of the pixels of teeth that show teeth, and of the others in the opening that do not."""
    V = rig.vertices(pose)
    height, width = mouth.inside.shape
    ids = rasterize(np.column_stack([face.project(V), face.camera.depth(V)]), face.faces, height, width).face_ids
    of_teeth = (face.region("teeth_upper") | face.region("teeth_lower"))[face.faces].all(1)
    teeth = (ids >= 0) & of_teeth[ids]
    others = mouth.inside & ~mouth.teeth
    hit = 100 * teeth[mouth.teeth].mean() if mouth.teeth.any() else np.nan
    return float(hit), float(100 * (1 - teeth[others].mean())) if others.any() else np.nan


def row(drawn: AlignedFace, rest: AlignedFace, rig: Rig, mouth: DrawnMouth | None) -> list[str]:
    """Of one way: apart, crossing (rest, jaw, smile, pose), misses, teeth (hit, spared)."""
    pose = fit_pose(rig, drawn.vertices, drawn.region("skin"), ridge=1e-4)
    posed = rig.vertices(pose)
    lips = drawn.region("mouth")
    corners = drawn.vertices[drawn.model.landmarks[[48, 54]]]
    miss = np.sqrt(((posed - drawn.vertices)[lips] ** 2).sum(1).mean()) / np.linalg.norm(corners[1] - corners[0])
    at_rest = crossing(rest, rig.neutral)
    others = (rig.vertices({"jawOpen": 1.0}), rig.vertices(dict.fromkeys(SMILE, 1.0)), posed)
    crossings = [at_rest, *(crossing(rest, V) - at_rest for V in others)]
    teeth = (np.nan, np.nan) if mouth is None else shown(drawn, rig, pose, mouth)
    apart = 100 * lips_apart(rest.model, rig.neutral)
    return [f"{apart:.1f}", *map(str, crossings), f"{100 * miss:.2f}", *(f"{share:.0f}" for share in teeth)]


def picture_row(picture: Picture) -> str:
    img, landmarks = read_image(picture.image), read_landmarks(picture.landmarks)
    fit = fit_3dmm(img, landmarks)
    plain = align_face(fit, landmarks)
    if lips_apart(plain.model, plain.vertices) < OPEN:
        lids = (lids_moved(plain, rig) for rig in (transferred(plain), build_rig(plain)))
        return " | ".join(["-"] * 8 + [" / ".join(f"{moved:.1f}" for moved in lids)])
    mouth = drawn_mouth(img, parse_face(img, landmarks, fit))
    drawn = size_teeth(plain, mouth)
    before, after = removed(plain), neutral_face(drawn)
    old, new = transferred(before), build_rig(after)
    lids = f"{lids_moved(before, old):.1f} / {lids_moved(after, new):.1f}"
    ways = (
        row(plain, before, fit_mouth(before, old), mouth),
        row(drawn, after, fit_mouth(after, new, drawn.vertices), mouth),
    )
    columns = [" / ".join(pair) for pair in zip(*ways, strict=True)]
    apart = f"{100 * lips_apart(plain.model, plain.vertices):.1f}: {columns[0]}"
    return " | ".join([apart, f"{crossing(plain, plain.vertices)}: {columns[1]}", *columns[2:6], *columns[6:], lids])


def main() -> None:
    found = pictures(sys.argv[1:])
    print("| picture | apart | crossing, rest | jaw | smile | pose | misses | teeth | spared | lids |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for picture in found:
        print(f"| {picture.name} | {picture_row(picture)} |", flush=True)
    print(roles("mouths", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
