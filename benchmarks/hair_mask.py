"""Hair masks against masks drawn by hand, and how far trust in them is deserved.

usage: python benchmarks/hair_mask.py [--sheet FILE.jpg] [NAME ...]

Needs the folder ``shared`` beside the checkout. The pictures are those of ``shared/data/hair_masks``; no tree was grown
on them. The limits of trust are chosen on CHOOSING of pictures.py and reported on JUDGING, and the other way round.
Edges of masks by hand are doubtful: ``clear`` is the overlap without what lies within 1.5 % of the head of the hand's
outline. The rival is GrabCut, seeded by the fitted head: a ring about its scalp is likely hair, face and border are
none.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys
import time
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import cv2
import numpy as np
from pictures import CHOOSING, roles

from toongeo import find_hair, fit_3dmm, read_image, read_landmarks
from toongeo.pipeline.parse.face_zones import face_zones
from toongeo.pipeline.parse.hair.hair_model import hair_model
from toongeo.pipeline.parse.hair.hair_trust import RULES, HairMeasures
from toongeo.pipeline.parse.hair.hair_view import hair_view
from toongeo.pipeline.parse.hair.head_zones import head_zones
from toongeo.pipeline.parse.hair.segment_hair import segment_hair
from toongeo.pipeline.parse.head_and_skin import head_and_skin
from toongeo.pipeline.parse.masks import signed_distance

DATA = Path(__file__).parents[2] / "shared" / "data"
GOOD = 0.85  # intersection over union that a trusted mask shall have
DOUBTFUL = 0.015  # head sizes on either side of the hand's outline


@dataclass
class Case:
    name: str
    found: float  # intersection over union, 1 for a bald head that is left bald
    clear: float
    rival: float
    seconds: float
    trusted: bool
    hairy: bool
    measures: HairMeasures
    sheet: np.ndarray


def number(name: str) -> str:
    """A picture's name in pictures.py."""
    return name[1:] if name[1:].isdigit() else name


def picture(name: str) -> tuple[np.ndarray, np.ndarray]:
    for folder in ("cartoons", "portraits"):
        if (DATA / folder / f"{name}.pts").exists():
            path = next(p for p in sorted((DATA / folder).glob(f"{name}.*")) if p.suffix != ".pts")
            return read_image(path), read_landmarks(DATA / folder / f"{name}.pts")
    number = name.removeprefix("c")
    return read_image(DATA / "caricatures" / f"{number}.jpg"), np.loadtxt(DATA / "caricatures" / f"{number}.txt")


def overlap(one: np.ndarray, two: np.ndarray) -> float:
    union = (one | two).sum()
    return float((one & two).sum() / union) if union else 1.0


def rival(img: np.ndarray, landmarks: np.ndarray, fit) -> np.ndarray:
    view = hair_view(img, fit)
    zones = head_zones(view, landmarks, fit)
    ring = cv2.dilate(zones.skull.astype(np.uint8), np.ones((45, 45), np.uint8)) > 0
    seeds = np.where(ring & (zones.up > 0) & ~zones.hull, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    seeds[zones.core | ~(cv2.dilate(ring.astype(np.uint8), np.ones((91, 91), np.uint8)) > 0)] = cv2.GC_BGD
    cv2.setRNGSeed(0)
    cv2.grabCut(view.pixels, seeds, (0, 0, 0, 0), np.zeros((1, 65)), np.zeros((1, 65)), 4, cv2.GC_INIT_WITH_MASK)
    mask = np.zeros(img.shape[:2], bool)
    front = ((seeds == cv2.GC_FGD) | (seeds == cv2.GC_PR_FGD)).astype(np.uint8)
    mask[view.window()] = cv2.resize(front, tuple(int(n) for n in view.size), interpolation=cv2.INTER_NEAREST) > 0
    return mask


def measured(name: str) -> Case:
    img, landmarks = picture(name)
    hand = cv2.imread(str(DATA / "hair_masks" / f"{name}.png"), cv2.IMREAD_GRAYSCALE) > 127
    fit = fit_3dmm(img, landmarks)
    start = time.process_time()
    hair = find_hair(img, landmarks, fit)
    seconds = time.process_time() - start
    view = hair_view(img, fit)
    cut = head_and_skin(view, face_zones(view, landmarks, fit))
    segmented = segment_hair(view, head_zones(view, landmarks, fit), cut, hair_model())
    other = rival(img, landmarks, fit)
    clear = np.abs(signed_distance(hand)) > DOUBTFUL * view.head / view.factors.mean()
    return Case(
        name,
        overlap(hair.mask, hand),
        overlap(hair.mask & clear, hand & clear),
        overlap(other, hand),
        seconds,
        hair.trusted,
        bool(hand.any()),
        segmented.measures,
        sheet(img, hand, hair, f"{name} {overlap(hair.mask, hand):.2f} {'; '.join(hair.reasons)}"),
    )


def sheet(img, hand, hair, text: str) -> np.ndarray:
    """The picture with the hand's outline (green), and with the found hair lit."""
    lit = (img * np.where(hair.mask, 1.0, 0.3)[..., None]).astype(np.uint8)
    if hair.hat is not None:
        lit[hair.hat] = lit[hair.hat] // 2 + np.array([120, 0, 120], np.uint8)
    scale = 300 / img.shape[0]
    small = [cv2.resize(a, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) for a in (img, lit)]
    outline = cv2.resize(hand.astype(np.uint8), small[0].shape[1::-1], interpolation=cv2.INTER_AREA)
    edge = cv2.morphologyEx(outline, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    small[1][edge] = 0, 255, 0
    tile = np.zeros((300, 480, 3), np.uint8)
    both = np.hstack(small)[:, :480]
    tile[:, : both.shape[1]] = both
    cv2.putText(tile, text[:70], (4, 294), 0, 0.42, (255, 60, 60), 1, cv2.LINE_AA)
    return tile


def chosen(cases: list[Case]) -> dict[str, tuple[float, float]]:
    """Limits that trust most pictures of a half, none of them wrongly; of equal ones those that ask most."""
    best, limits = (-1, 0.0), {}
    grid = np.arange(1.4, 1.81, 0.02), np.arange(0.7, 0.96, 0.05), (0.0, 0.8, 0.9, 0.95)
    for certainty, agreement, outlined in product(*grid):
        trial = {"certainty": (certainty, 2.2), "agreement": (agreement, 1.0), "outlined": (outlined, 1.0)}
        kept = [case for case in cases if trusted_by(case, trial)]
        wrong = [case for case in kept if case.found < GOOD or not case.hairy]
        score = len(kept) - 5 * len(wrong), float(certainty + agreement + outlined)
        if score > best:
            best, limits = score, trial
    return limits


def trusted_by(case: Case, limits: dict[str, tuple[float, float]]) -> bool:
    """The rules in use, with other limits for some."""
    rules = [(name, *limits.get(name, (least, most))) for name, least, most, _ in RULES]
    return all(least <= getattr(case.measures, name) <= most for name, least, most in rules)


def main() -> None:
    arguments = sys.argv[1:]
    where = arguments.index("--sheet") if "--sheet" in arguments else None
    out = None if where is None else Path(arguments[where + 1])
    names = [a for k, a in enumerate(arguments) if where is None or k not in (where, where + 1)]
    cases = [measured(name) for name in names or sorted(path.stem for path in (DATA / "hair_masks").glob("*.png"))]
    keys = [*asdict(cases[0].measures), "certainty"]
    print("| picture | IoU | clear | rival | trusted | s | " + " | ".join(keys) + " |")
    print("|" + "---|" * (6 + len(keys)))
    for case in cases:
        values = " | ".join(f"{getattr(case.measures, key):.2f}" for key in keys)
        verdict = "yes" if case.trusted else "no"
        figures = f"{case.found:.3f} | {case.clear:.2f} | {case.rival:.2f} | {verdict} | {case.seconds:.2f}"
        print(f"| {case.name} | {figures} | {values} |")
    summary("all", cases, [case.trusted for case in cases])
    halves = [[case for case in cases if (number(case.name) in CHOOSING) == first] for first in (True, False)]
    for part, rest, title in ((*halves, "CHOOSING"), (*halves[::-1], "JUDGING")):
        if not part or not rest:
            continue
        summary(f"limits in use, on {title}", part, [case.trusted for case in part])
        limits = chosen(part)
        text = ", ".join(f"{name} {low:.2f}-{high:.2f}" for name, (low, high) in limits.items())
        summary(f"limits of {title} ({text}) on the other half", rest, [trusted_by(case, limits) for case in rest])
    print(roles("hair_mask", [number(case.name) for case in cases]))
    print("limits in use:", {name: (least, most) for name, least, most, _ in RULES})
    if out:
        tiles = [case.sheet for case in cases] + [np.zeros_like(cases[0].sheet)] * (-len(cases) % 4)
        rows = [np.hstack(tiles[k : k + 4]) for k in range(0, len(tiles), 4)]
        cv2.imwrite(str(out), np.vstack(rows)[..., ::-1])


def summary(title: str, cases: list[Case], trusted: list[bool]) -> None:
    hairy = [case for case in cases if case.hairy]
    kept = [case for case, yes in zip(cases, trusted, strict=True) if yes]
    found = [case.found for case in hairy]
    good = [case.found for case in kept]
    print(
        f"{title}: {len(hairy)} hairy, IoU mean {np.mean(found):.3f} median {np.median(found):.3f} "
        f"(rival {np.mean([case.rival for case in hairy]):.3f}); trusted {len(kept)}, mean {np.mean(good or [0]):.3f}, "
        f"least {min(good, default=0):.3f}, below {GOOD}: {[c.name for c in kept if c.found < GOOD or not c.hairy]}"
    )


if __name__ == "__main__":
    main()
