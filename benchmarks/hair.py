"""Hair as a shell against hair painted on the head: one table over pictures.

``python benchmarks/hair.py FOLDER_OF_MASKS PICTURE ...``: pictures with landmarks of the same name beside them (.pts or
.txt) and masks of their hair, made by hand (NAME.png, or cN.png for a picture N). With ``--found`` the shell is built
from the mask that the program finds, where it trusts it. Of each picture:

- IoU: of the hair that is seen by the picture's camera with the mask by hand, and with the mask that it was built from.
- silhouette: IoU of head and hair above the chin with the picture's (masks/NAME.png beside the picture, or else hair
  and what the parser takes for the head), painted -> shell.
- through: pixels where skin lies up to 5 mm before hair, in patches that do not touch the hair's edge or reach more
  than 8 mm from it, in % of the hair's pixels; the worst of 12 views around the head.
- before: in the picture's view, cells of 1 mm of hair where the head lies more than 1 mm before it, in %, the worst of
  the rig's expressions and the presets; then the same without hair that lies more than 30 mm behind the skin: that
  hangs behind the head, and a cheek that is puffed out beside it covers it, and does not come through.
- moved: by how much visible landmarks moved to make room, mm.
- open: edges that are not of two triangles; crossing: pairs of triangles that intersect.
- seconds: of CPU, of the stage (room, shell and texture), best of three.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import time
from pathlib import Path

import cv2
import numpy as np

import toongeo as tg
from toongeo.avatar import Avatar
from toongeo.avatar.making.add_hair import add_hair
from toongeo.geometry import self_intersections
from toongeo.model.expression_schemes import PRESETS
from toongeo.pipeline import Hair
from toongeo.protocols import Camera, FaceLabel
from toongeo.render import Fragments, ScaledOrthographicCamera, interpolate, rasterize

VIEWS, SIDE = 12, 320
NEAR_MM, EDGE_MM, BEFORE_MM = 5.0, 8.0, 1.0
BEHIND_MM = 30.0  # half of the depth of a cheek: hair so far behind the skin does not lie on it
SIX = ("anger", "disgust", "fear", "sadness", "smile", "surprise")
HEAD = [label for label in FaceLabel if label != FaceLabel.BACKGROUND]


def drawn(camera: Camera, V: np.ndarray, F: np.ndarray, shape: tuple[int, int]) -> tuple[Fragments, np.ndarray]:
    """Fragments of a mesh, and the depth of each pixel, -inf where there is none."""
    depth = camera.depth(V)
    fragments = rasterize(np.column_stack([camera.project(V), depth]), F, *shape)
    return fragments, np.where(fragments.mask, interpolate(fragments, F, depth), -np.inf)


def iou(a: np.ndarray, b: np.ndarray) -> float:
    return float((a & b).sum() / max(1, (a | b).sum()))


def seen_hair(avatar: Avatar, shape: tuple[int, int], factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Pixels of the picture, enlarged, where hair is foremost, and where head or hair is."""
    camera = avatar.face.camera.cropped(np.zeros(2), factor)
    head = drawn(camera, avatar.face.vertices, avatar.faces, shape)[1]
    if avatar.hair is None:
        return np.zeros(shape, bool), np.isfinite(head)
    hair = drawn(camera, avatar.hair.vertices, avatar.hair.faces, shape)[1]
    return hair > head, np.isfinite(head) | np.isfinite(hair)


def outer_faces(avatar: Avatar) -> np.ndarray:
    F = avatar.faces
    return F[(avatar.face.region("skin") | avatar.face.region("neck"))[F].all(1)]


def through(avatar: Avatar, hair: Hair) -> float:
    """Worst share of the hair's pixels, %, where skin comes through."""
    centre, worst = hair.vertices.mean(0), 0.0
    parts = avatar.surfaces()[:3]  # head and eyeballs
    offsets = np.cumsum([0, *(len(part.vertices) for part in parts)])
    V = np.vstack([part.vertices for part in parts])
    F = np.vstack([part.faces + offset for part, offset in zip(parts, offsets, strict=False)])
    for yaw in range(0, 360, 360 // VIEWS):
        camera = ScaledOrthographicCamera.look(yaw, 0, size=SIDE, centre=centre, extent=400)
        fragments, front = drawn(camera, hair.vertices, hair.faces, (SIDE, SIDE))
        skin = drawn(camera, V, F, (SIDE, SIDE))[1]
        bare = fragments.mask & (skin > front)
        shown = fragments.mask & ~bare
        # Where hair ends it goes into the head, and skin lies before it, ever farther.
        ended = ~fragments.mask | (skin > front + NEAR_MM)
        _, pieces = cv2.connectedComponents((bare & (skin < front + NEAR_MM)).astype(np.uint8))
        at_edge = np.isin(pieces, pieces[cv2.dilate(ended.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0])
        away = cv2.distanceTransform((~ended).astype(np.uint8), cv2.DIST_L2, 5) * 400 / SIDE
        bad = (pieces > 0) & (~at_edge | (away > EDGE_MM))
        worst = max(worst, 100 * float(bad.sum()) / max(1, int(shown.sum())))
    return worst


def before(avatar: Avatar, hair: Hair, mask: np.ndarray) -> tuple[float, str, float]:
    """Worst share of cells of hair, %, where the head lies before it in an expression, its name, and the worst share
    where it lies closely before it."""
    millimetres = 1 / float(np.linalg.norm(avatar.face.camera.jacobian(np.zeros((1, 3)))[0, 0]))
    shape = (int(mask.shape[0] * millimetres) + 1, int(mask.shape[1] * millimetres) + 1)
    cells = cv2.resize(mask.astype(np.uint8), shape[::-1], interpolation=cv2.INTER_AREA)
    cells = cv2.erode(cells, np.ones((5, 5), np.uint8)) > 0
    camera = avatar.face.camera.cropped(np.zeros(2), millimetres)
    front = drawn(camera, hair.vertices, hair.faces, shape)[1]
    cells &= np.isfinite(front)
    F, worst, near = outer_faces(avatar), (0.0, "none"), 0.0
    for name in (*avatar.names, *SIX):
        V = avatar.vertices(PRESETS[name] if name in SIX else {name: 1.0})
        skin = drawn(camera, V, F, shape)[1]
        over = cells & (skin > front + BEFORE_MM)
        worst = max(worst, (100 * float(over.sum()) / max(1, int(cells.sum())), name))
        near = max(near, 100 * float((over & (skin < front + BEHIND_MM)).sum()) / max(1, int(cells.sum())))
    return *worst, near


def open_edges(F: np.ndarray) -> int:
    edges = np.sort(np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), 1)
    return int((np.unique(edges, axis=0, return_counts=True)[1] != 2).sum())


def head_mask(picture: Path, avatar: Avatar, mask: np.ndarray) -> np.ndarray:
    by_hand = picture.parent / "masks" / f"{picture.stem}.png"
    if by_hand.is_file():
        return tg.read_image(by_hand)[..., 0] > 127
    return mask | avatar.parse.mask(*HEAD)


def measured(picture: Path, masks: Path, found: bool) -> str:
    img = tg.read_image(picture)
    points = next(p for p in (picture.with_suffix(".pts"), picture.with_suffix(".txt")) if p.is_file())
    landmarks = tg.read_landmarks(points)
    stem = f"c{picture.stem}" if picture.stem.isdigit() else picture.stem
    mask = tg.read_image(masks / f"{stem}.png")[..., 0] > 127
    painted = tg.make_avatar(img, landmarks, hair=False, texture_size=64)
    avatar = tg.make_avatar(img, landmarks, hair_mask=None if found else mask, texture_size=64)
    if avatar.hair is None:
        why = "; ".join(w for w in avatar.report.warnings if "hair" in w)
        return f"| {stem} | no shell: {why} " + "| " * 11 + "|"
    hair, own = avatar.hair, avatar.parse.hair.mask
    factor = 2.0 if max(img.shape) < 900 else 1.0
    shape = (int(img.shape[0] * factor), int(img.shape[1] * factor))
    large = [cv2.resize(m.astype(np.uint8), shape[::-1], interpolation=cv2.INTER_NEAREST) > 0 for m in (mask, own)]
    visible, outline = seen_hair(avatar, shape, factor)
    chin = int(avatar.face.project(avatar.face.vertices[avatar.face.landmark_vertices[[8]]])[0, 1] * factor)
    head = cv2.resize(head_mask(picture, painted, mask).astype(np.uint8), shape[::-1]) > 0
    bare = seen_hair(painted, shape, factor)[1]
    silhouettes = [iou((head | large[0])[:chin], s[:chin]) for s in (bare, outline)]
    still = avatar.face.landmark_vertices
    px = np.rint(painted.face.project(painted.face.vertices[still])).astype(int)
    px = np.clip(px, 0, np.array(mask.shape[::-1]) - 1)
    way = np.linalg.norm(avatar.face.vertices[still] - painted.face.vertices[still], axis=1)
    moved = float(way[~own[px[:, 1], px[:, 0]]].max(initial=0))
    seconds = []
    for _ in range(3):
        started = time.process_time()
        add_hair(img, painted.face, painted.rig, avatar.parse)
        seconds.append(time.process_time() - started)
    share, name, near = before(avatar, hair, own)
    return (
        f"| {stem} | {iou(visible, large[0]):.3f} | {iou(visible, large[1]):.3f} "
        f"| {silhouettes[0]:.3f} -> {silhouettes[1]:.3f} | {through(avatar, hair):.2f} | {share:.3f} | {name} "
        f"| {near:.3f} | {moved:.2f} | {open_edges(hair.faces)} | {len(self_intersections(hair.vertices, hair.faces))} "
        f"| {len(hair.faces)} | {min(seconds):.2f} |"
    )


def main() -> None:
    arguments = [a for a in sys.argv[1:] if not a.startswith("--")]
    masks, pictures = Path(arguments[0]), [Path(name) for name in arguments[1:]]
    print("| picture | IoU with mask by hand | with its own mask | silhouette of the head, painted -> shell ", end="")
    print("| skin through, % | head before hair, % | worst in | near it, % | landmarks moved, mm ", end="")
    print("| open edges | crossing | triangles | CPU s |\n" + "|---" * 13 + "|")
    for picture in pictures:
        print(measured(picture, masks, "--found" in sys.argv), flush=True)


if __name__ == "__main__":
    main()
