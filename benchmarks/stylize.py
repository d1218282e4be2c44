"""Drawings of photographs: warps that must not fold, who is still recognised, what became of hair and skin, seconds.

usage: PYTHONPATH=.:data_templates/build python benchmarks/stylize.py warps|people|renders|seconds|memory [SHARED]
       PYTHONPATH=.:data_templates/build python benchmarks/stylize.py pairs FOLDER KEY

SHARED is the folder with ``data/models/ict_facekit`` for ``people``. Renders are of seeds: constants of the appearance
were chosen on those of 77 (and on the astronaut, image_0010, takeo and einstein), the figures are of 78; pairs for a
blind judge, which go to FOLDER while which side is ours goes to the file KEY, are of 79.
"""

import itertools
import json
import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import resource
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from pictures import FOLDER, roles
from scipy.interpolate import RBFInterpolator

import toongeo as tg
from toongeo.colour.cielab import cielab
from toongeo.io import write_image
from toongeo.model import default_model
from toongeo.pipeline import STYLES
from toongeo.pipeline.stylize.exaggerated import exaggerated
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.style_rules import style_rules
from toongeo.pipeline.stylize.velocity_warp import velocity_warp

SHAPE = (640, 640)


def main() -> None:
    tasks = {"warps": warps, "people": people, "renders": renders, "seconds": seconds, "memory": memory, "pairs": pairs}
    tasks[sys.argv[1]]()


def warps(count: int = 1000) -> None:
    """Random faces of the model, turned and noisy, in every style at strengths 0 to 2."""
    model, least, folded, rival = default_model(), np.inf, 0, 0
    styles = sorted(style_rules())
    for seed in range(count):
        rng = np.random.default_rng([9, seed])
        V = model.vertices(rng.normal(size=len(model.identity)), rng.uniform(0, 0.4, len(model.expression)))
        points = V[model.landmarks][:, :2] * [1.7, -1.7] + [320, 300] + rng.normal(size=(68, 2)) * rng.uniform(0, 6)
        moved = rng.normal(size=(68, 2)) * 12 if seed % 5 == 0 else None
        warp = velocity_warp(SHAPE, points, style_rules()[styles[seed % 5]], rng.uniform(0, 2), moved)
        determinants = warp.determinants()
        folded, least = folded + (determinants <= 0).any(), min(least, float(determinants.min()))
        if seed % 10 == 0:
            rival += folds(points, warp.points(points))
    print(f"{count} warps: {folded} folded, smallest determinant {least:.3f}")
    print(f"thin plates to the same landmarks: {rival} of {count // 10} folded")


def folds(source: np.ndarray, target: np.ndarray) -> bool:
    """Whether the thin plate that takes landmarks to others, and keeps the corners, folds somewhere."""
    corners = np.array([[0, 0], [639, 0], [0, 639], [639, 639.0]])
    plate = RBFInterpolator(np.vstack([source, corners]), np.vstack([target, corners]), kernel="thin_plate_spline")
    nodes = np.stack(np.meshgrid(np.arange(0, 640, 4.0), np.arange(0, 640, 4.0)), axis=-1)
    moved = plate(nodes.reshape(-1, 2)).reshape(nodes.shape)
    across, down = np.diff(moved, axis=1)[:-1], np.diff(moved, axis=0)[:, :-1]
    return bool((across[..., 0] * down[..., 1] - across[..., 1] * down[..., 0] <= 0).any())


def people(count: int = 100, draws: int = 10, among: int = 30) -> None:
    """Recognition of frontal people of ICT-FaceKit by landmarks, each among 30 and among all of them."""
    model = tg.load_ict_facekit(Path(sys.argv[2]) / "data/models/ict_facekit/ict_facekit_light.npz")
    photos, drawn = [], {style: [] for style in STYLES}
    for person in range(count):
        rng = np.random.default_rng([6, person])
        V = model.vertices(0.8 * rng.normal(size=len(model.identity)))
        points = V[model.landmarks][:, :2] * [1.6, -1.6] + [320, 300]
        fit = tg.fit_3dmm(None, points)
        photos.append(points)
        for style, found in drawn.items():
            special = STYLES[style].exaggeration * exaggerated(points, fit)
            found.append(velocity_warp(SHAPE, points, style_rules()[style], 1.0, special).points(points))
    print("share recognised: noisy drawings (3 % of the face size) among photographs, nearest; noisy photographs (2 %)")
    print("among drawings, by cosine; each set without its mean")
    for style, found in {"photo": photos, **drawn}.items():
        shares = [
            100 * np.mean([recognised(found[k : k + size], photos[k : k + size], draws) for k in starts], axis=0)
            for size, starts in ((among, range(0, count - among + 1, among)), (count, (0,)))
        ]
        few, all_ = shares
        print(
            f"{style:12s} among {among}: {few[0]:5.1f} {few[1]:5.1f} %   among {count}: {all_[0]:5.1f} {all_[1]:5.1f} %"
        )


def recognised(drawn: list, photos: list, draws: int) -> tuple[float, float]:
    """Shares of noisy drawings nearest to their own photograph, and of photographs most like their own drawing."""
    own = np.arange(len(photos))
    right, back = [], []
    for draw in range(draws):
        rng = np.random.default_rng([7, draw])
        probes = centred(drawn, 0.03, rng)
        right.append(np.square(probes[:, None] - centred(photos, 0.0)).sum((2, 3)).argmin(1) == own)
        probes, others = centred(photos, 0.02, rng), centred(drawn, 0.0)
        alike = np.einsum("pij,gij->pg", probes, others) / np.sqrt(np.square(others).sum((1, 2)))
        back.append(alike.argmax(1) == own)
    return float(np.mean(right)), float(np.mean(back))


def centred(faces: list, noise: float, rng: np.random.Generator | None = None) -> np.ndarray:
    """Shapes (n, 68, 2) without place and size, less their mean; noise in face sizes."""
    shapes = []
    for points in faces:
        size = face_frame(points).size
        points = points + (noise * size * rng.normal(size=(68, 2)) if rng is not None else 0)
        points = points - points.mean(axis=0)
        shapes.append(points / np.sqrt(np.square(points).sum()))
    return np.array(shapes) - np.mean(shapes, axis=0)


def scenes(seed: int, yaw: float, size: int) -> Iterator[Any]:
    """Renders of people that look at most so many degrees aside."""
    from renders.scene import random_scene

    for number in itertools.count():
        scene = random_scene(np.random.default_rng([seed, number]), "person", size=size)
        if abs(scene.yaw) <= yaw:
            yield scene


def renders(count: int = 20) -> None:
    """What became of the skin, the hair and glasses of renders of people."""
    from renders.scene import Part

    from toongeo.pipeline.stylize.stylize import subject_for

    hair_as_skin, lightness, rims = [], [], []
    for scene in itertools.islice(scenes(78, 25, 420), count):
        img = np.clip(scene.picture, 0, 255).astype(np.uint8)
        drawn = tg.stylize(img, scene.landmarks, "toon")
        fit = tg.fit_3dmm(None, scene.landmarks)
        subject = subject_for(img, scene.landmarks, fit, drawn.warp, STYLES["toon"], drawn.hair)
        seen = {part: drawn.warp.picture((scene.parts == part).astype(np.float32)) > 0.9 for part in Part}
        if seen[Part.HAIR].sum() > 500:
            hair_as_skin.append(float((subject.full(subject.skin.drawn)[seen[Part.HAIR]] > 0.5).mean()))
        before = np.median(cielab(img)[scene.parts == Part.SKIN][:, 0])
        lightness.append(float(np.median(cielab(drawn.img)[seen[Part.SKIN]][:, 0]) - before))
        if (scene.parts == Part.GLASSES).sum() > 200:
            rims.append(contrast(cielab(drawn.img)[..., 0], seen[Part.GLASSES], seen[Part.SKIN]))
    worse = sum(share > 0.01 for share in hair_as_skin)
    print(f"{count} renders, toon; hair taken for skin: median {100 * np.median(hair_as_skin):.2f} % of its pixels,")
    print(f"  mean {100 * np.mean(hair_as_skin):.2f} %, above 1 % on {worse} of {len(hair_as_skin)}")
    print(f"lightness of skin: {np.mean(lightness):+.1f} L* in the mean, at most {np.abs(lightness).max():.1f}")
    print(f"rims of glasses against the skin around: {', '.join(f'{rim:.0f}' for rim in rims) or 'none'} L*")


def contrast(lightness: np.ndarray, rim: np.ndarray, skin: np.ndarray) -> float:
    around = cv2.dilate(rim.astype(np.uint8), np.ones((9, 9), np.uint8)).astype(bool) & skin
    return float(abs(np.median(lightness[rim]) - np.median(lightness[around]))) if rim.any() and around.any() else 0.0


RIVALS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "cv2.stylization": lambda img: cv2.stylization(img, sigma_s=60, sigma_r=0.45),
    "cv2.pencilSketch": lambda img: cv2.pencilSketch(img, sigma_s=60, sigma_r=0.07, shade_factor=0.05)[1],
    "bilateral and edges": lambda img: bilateral_and_edges(img),
}


def bilateral_and_edges(img: np.ndarray) -> np.ndarray:
    """The usual recipe: bilateral filters at half the size, and dark lines by an adaptive threshold."""
    small = cv2.pyrDown(img)
    for _ in range(7):
        small = cv2.bilateralFilter(small, 9, 9, 7)
    smooth = cv2.resize(small, img.shape[1::-1], interpolation=cv2.INTER_LINEAR)
    grey = cv2.medianBlur(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY), 7)
    lines = cv2.adaptiveThreshold(grey, 255, cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY, 9, 2)
    return cv2.bitwise_and(smooth, smooth, mask=lines)


def pairs(count: int = 42) -> None:
    """Sheets of a photograph and two drawings of it, ours and a rival's in an order that only the key tells."""
    folder, key = Path(sys.argv[2]), {}
    folder.mkdir(parents=True, exist_ok=True)
    order = np.random.default_rng(79)
    for number, scene in enumerate(itertools.islice(scenes(79, 18, 512), count)):
        img = np.clip(scene.picture, 0, 255).astype(np.uint8)
        rival = list(RIVALS)[number % len(RIVALS)]
        style = "ink" if number % 6 == 1 else "toon"  # a half of those against pencils
        drawings = {"ours": tg.stylize(img, scene.landmarks, style).img, "rival": RIVALS[rival](img)}
        left, right = order.permutation(list(drawings))
        gap = np.full((len(img), 12, 3), 255, np.uint8)
        sheet = np.hstack([img, gap, drawings[left], gap, drawings[right]])
        write_image(folder / f"pair_{number:02d}.png", sheet)
        key[f"pair_{number:02d}"] = {"left": left, "right": right, "rival": rival, "style": style}
    Path(sys.argv[3]).write_text(json.dumps(key, indent=1))


def memory(side: int = 6325) -> None:
    """Most memory of the process while a picture of 40 megapixels is drawn."""
    img, points = tg.read_image(FOLDER / "astronaut.png"), tg.read_landmarks(FOLDER / "astronaut.pts")
    factor = side / len(img)
    img = cv2.resize(img, (side, side), interpolation=cv2.INTER_LINEAR)
    tg.stylize(img, (points + 0.5) * factor - 0.5)
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{side**2 / 1e6:.0f} MP: the process holds {most:.0f} MB at most; the picture is {img.nbytes / 2**20:.0f}")


def seconds() -> None:
    """Processor seconds for a picture of 1024 px, beside what OpenCV has."""
    img = tg.read_image(FOLDER / "astronaut.png")
    points = tg.read_landmarks(FOLDER / "astronaut.pts")
    img = cv2.resize(img, (1024, 1024), interpolation=cv2.INTER_CUBIC)
    points = (points + 0.5) * 2 - 0.5
    rivals = {name: lambda run=run: run(img) for name, run in RIVALS.items()}
    for name, run in {**{style: lambda s=style: tg.stylize(img, points, s) for style in STYLES}, **rivals}.items():
        run()
        started = time.process_time()
        run()
        print(f"{name:18s} {time.process_time() - started:5.2f} s")
    print(roles("stylize", ["astronaut"]))


if __name__ == "__main__":
    main()
