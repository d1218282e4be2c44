"""What is seen of a head at first sight: lids, nose, skull and forehead, in figures that need no annotation.

usage: python benchmarks/looks.py [FOLDER ...]
(pictures with .pts or .txt beside them; default: the bundled examples)

soot: share of the skin that a closed eye shows, away from the line at its edge, that is more than 15 L (CIELAB)
darker than the skin around the eye, percent; spread: standard deviation of its lightness. nose: how far its tip
stands before the plane of inner eye corners and mouth corners, over that of the mean face of the same size. skull:
how far the head without hair rises above the hair and skin of the picture, percent of the face's height (brows to
chin). ears: largest over least stretch of an ear, the worse one. forehead: median difference of picture and texture
over the forehead that the picture shows as skin, levels of 255.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys

import cv2
import numpy as np
from pictures import CHOSEN_ON, pictures, roles

from toongeo import make_avatar, read_image, read_landmarks
from toongeo.avatar import Avatar
from toongeo.colour.cielab import cielab
from toongeo.model.anatomy.lid_rings import lid_rings
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.texture.lids.lid_membrane import lid_ring
from toongeo.pipeline.texture.lids.lid_zones import lid_zone, skin_edges
from toongeo.pipeline.texture.vertex_colours import vertex_colours
from toongeo.protocols import FaceLabel

SOOT = 15.0  # CIELAB lightness below the skin around the eye
CORNERS = [39, 42, 48, 54]  # inner eye corners, mouth corners


def lids(avatar: Avatar) -> tuple[float, float]:
    """Percent of the closed lids that are sooty, and standard deviation of their lightness; the worse eye."""
    model, rig = avatar.face.model, avatar.rig
    edges = skin_edges(model)
    colours = vertex_colours(model, cv2.GaussianBlur(avatar.texture, (0, 0), 2.4))
    light = cielab(np.clip(np.rint(colours), 0, 255).astype(np.uint8)[None])[0, :, 0]
    worst = np.zeros(2)
    for side in SIDES:
        zone = lid_zone(model, rig, side, edges)
        _, ring = lid_ring(model, side, zone, edges)
        rims = np.isin(np.arange(len(zone)), lid_rings(model, side).vertices)
        for _ in range(2):
            rims = rims | (edges @ rims > 0)
        lid = np.flatnonzero((zone > 0.6) & ~rims)
        closed = rig.vertices({f"eyeBlink{side.capitalize()}": 1.0})
        area = vertex_areas(closed, model.faces)[lid]
        if not area.sum():
            continue  # an eye that is drawn shut has none
        around = light[ring]
        skin = np.median(around[around >= np.percentile(around, 40)])
        soot = 100 * area[light[lid] < skin - SOOT].sum() / area.sum()
        middle = np.average(light[lid], weights=area)
        worst = np.maximum(worst, [soot, np.sqrt(np.average((light[lid] - middle) ** 2, weights=area))])
    return float(worst[0]), float(worst[1])


def vertex_areas(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    area = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1) / 6
    return np.bincount(F.ravel(), area.repeat(3), len(V))


def nose(avatar: Avatar) -> float:
    """Protrusion of the nose over that of the mean face, each over the width of its face."""
    model = avatar.face.model

    def protrusion(V: np.ndarray) -> float:
        points = V[model.landmarks]
        middle = points[CORNERS].mean(0)
        normal = np.linalg.svd(points[CORNERS] - middle)[2][2]
        width = np.linalg.norm(points[0] - points[16])
        return float(((V[model.region("nose")] - middle) @ (normal * np.sign(normal[2]))).max() / width)

    return protrusion(avatar.vertices()) / protrusion(model.mean)


def skull(avatar: Avatar) -> float:
    """Percent of the face's height by which the head rises above what the picture shows as hair, hat or skin."""
    face, parse = avatar.face, avatar.parse
    px = face.project(face.vertices)
    up = px[face.landmark_vertices[27]] - px[face.landmark_vertices[8]]
    height = float(np.linalg.norm(px[face.landmark_vertices[17:27]].mean(0) - px[face.landmark_vertices[8]]))
    up = up / np.linalg.norm(up)
    head = parse.mask(*(label for label in FaceLabel if label != FaceLabel.BACKGROUND))
    y, x = np.nonzero(head)
    drawn = np.percentile(np.column_stack([x, y]) @ up, 99.8)
    return float(100 * max(0.0, (px[face.region("skin")] @ up).max() - drawn) / height)


def ears(avatar: Avatar) -> float:
    """Largest over least stretch of an ear against that of the fit, the worse of both; those under hair give way."""
    if avatar.hair is not None:
        return float("nan")
    fit, V, worst = avatar.fit.vertices, avatar.face.vertices, 1.0
    for side in SIDES:
        ear = avatar.face.region(f"ear_{side}")
        linear = np.linalg.lstsq(fit[ear] - fit[ear].mean(0), V[ear] - V[ear].mean(0), rcond=None)[0]
        stretches = np.linalg.svd(linear, compute_uv=False)
        worst = max(worst, stretches[0] / stretches[-1])
    return float(worst)


def forehead(avatar: Avatar, img: np.ndarray) -> float:
    """Median difference, in levels, of picture and texture on forehead that the parse calls skin."""
    face = avatar.face
    colours = vertex_colours(face.model, cv2.GaussianBlur(avatar.texture, (0, 0), 2.0))
    px = np.rint(face.project(face.vertices)).astype(int)
    inside = ((px >= 0) & (px < img.shape[1::-1])).all(1)
    ahead = face.camera.view(face.normals + face.vertices)[:, 2] - face.camera.view(face.vertices)[:, 2] > 0.5
    skin = cv2.erode(avatar.parse.mask(FaceLabel.SKIN).astype(np.uint8), np.ones((3, 3))) > 0
    at = np.flatnonzero(face.region("forehead") & inside & ahead)
    at = at[skin[px[at, 1], px[at, 0]]]
    if len(at) < 20:
        return float("nan")
    drawn = cv2.GaussianBlur(img, (0, 0), 1.0)[px[at, 1], px[at, 0]].astype(float)
    return float(np.median(np.abs(drawn - colours[at]).max(1)))


def row(avatar: Avatar, img: np.ndarray) -> list[float]:
    return [*lids(avatar), nose(avatar), skull(avatar), ears(avatar), forehead(avatar, img)]


def main() -> None:
    found, rows = pictures(sys.argv[1:]), []
    print("| picture | soot % | nose | skull % | ears | forehead |\n|---|---|---|---|---|---|")
    for picture in found:
        img = read_image(picture.image)
        rows.append(row(make_avatar(img, read_landmarks(picture.landmarks)), img))
        soot, _, tip, top, flap, levels = rows[-1]
        print(
            f"| {picture.name} | {soot:.1f} | {tip:.2f} | {top:.1f} | {flap:.2f} | {levels:.0f} |",
            flush=True,
        )
    soot, _, tip, top, flap, levels = np.array(rows).T
    found_in = {
        "lids sooty (> 15 %)": soot > 15,
        "noses > 1.5": tip > 1.5,
        "noses > 2.2": tip > 2.2,
        "skulls > 2 %": top > 2,
        "ears > 1.5": flap > 1.5,
        "foreheads > 25 levels": levels > 25,
    }
    chosen = np.array([picture.name in CHOSEN_ON["looks"] for picture in found])
    print("\n| faces with | of pictures that constants were chosen on | of those only looked at |\n|---|---|---|")
    for name, faces in found_in.items():
        counts = " | ".join(f"{int(faces[half].sum())} of {half.sum()}" for half in (chosen, ~chosen))
        print(f"| {name} | {counts} |")
    print(roles("looks", [picture.name for picture in found]))


if __name__ == "__main__":
    main()
