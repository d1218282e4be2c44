"""Renders as arrays to train on, the same whatever the number of processes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from drawn_eyes import with_drawn_eyes
from figures import exaggerated_head, random_figure
from numpy.typing import NDArray
from renders.render_face import drawn, random_style
from renders.scene import Scene, random_scene

from detector.workers import mapped
from toongeo.model.ibug68 import MIRROR

__all__ = [
    "KINDS",
    "SIZE_PX",
    "Samples",
    "first_samples",
    "joined_samples",
    "mirrored",
    "rendered_samples",
    "with_even_jaw",
]

SIZE_PX = 256
# Kinds of heads: the first three as `renders` has them, then those of `figures`.
KINDS = ("person", "caricature", "cartoon", "exaggerated", "figure")
# Shares of the kinds in each mix; where they do not add to 1, the others are left out.
_MIXES = {
    "usual": (0.45, 0.30, 0.25, 0, 0),
    "drawn": (0, 0.16, 0.14, 0.14, 0.24),
    "every": (0.32, 0.16, 0.14, 0.14, 0.24),
}
_DRAWN_EYES = 0.5  # of the cartoons
_FLAT = ("flat", "ink", "painted", "posterized", "pencil", "grey")
_FLAT_SHARES = (0.55, 0.09, 0.12, 0.08, 0.08, 0.08)  # how figures are drawn
_STYLES_A_HEAD = 2  # a second style costs a fifth of a head
_CHUNK = 50  # heads


@dataclass(frozen=True, eq=False)
class Samples:
    """`grey` (n, 256, 256) uint8, `landmarks` (n, 68, 2) px, `kinds` (n,) index into KINDS."""

    grey: NDArray[np.uint8]
    landmarks: NDArray[np.float64]
    kinds: NDArray[np.int64]


_ARRAYS = ("grey", "landmarks", "kinds")


def rendered_samples(seed: int, heads: int, mix: str, processes: int, cache: Path | None = None) -> Samples:
    """Two drawings of each of so many heads of a mix; chunks of them are kept in the folder `cache`, and read if they
    are there."""
    chunks = [(seed, k, min(k + _CHUNK, heads), mix, cache) for k in range(0, heads, _CHUNK)]
    return joined_samples(mapped(_chunk, chunks, processes))


def joined_samples(parts: Sequence[Samples]) -> Samples:
    """Samples one after the other."""
    return Samples(*(np.concatenate([getattr(part, name) for part in parts]) for name in _ARRAYS))


def first_samples(samples: Samples, count: int) -> Samples:
    """The first of them."""
    return Samples(*(getattr(samples, name)[:count] for name in _ARRAYS))


def mirrored(grey: NDArray[np.uint8], landmarks: NDArray[np.float64]) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """A picture and its points, left and right exchanged."""
    points = landmarks[MIRROR].copy()
    points[:, 0] = grey.shape[1] - 1 - points[:, 0]
    return np.ascontiguousarray(grey[:, ::-1]), points


def with_even_jaw(landmarks: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (68, 2) with those of the jaw at even distances along it from either end to the chin.

    Annotators place them so (C. Sagonas et al., "300 faces in-the-wild challenge", 2016); the template has them on
    bones.
    """
    points, jaw = landmarks.copy(), landmarks[:17]
    along = np.append(0, np.cumsum(np.maximum(np.linalg.norm(np.diff(jaw, axis=0), axis=1), 1e-3)))
    places = np.append(np.linspace(0, along[8], 9), np.linspace(along[8], along[16], 9)[1:])
    points[:17] = np.column_stack([np.interp(places, along, jaw[:, axis]) for axis in range(2)])
    return points


def _chunk(chunk: tuple[int, int, int, str, Path | None]) -> Samples:
    seed, first, last, mix, cache = chunk
    path = None if cache is None else cache / f"{mix}_{seed}_{first}_{last}.npz"
    if path is not None and path.exists():
        with np.load(path) as archive:
            return Samples(*(archive[name] for name in _ARRAYS))
    grey, landmarks, numbers = [], [], []
    shares = np.array(_MIXES[mix])
    for k in range(first, last):
        rng = np.random.default_rng([seed, k])  # of the head alone: chunks may run in any order
        kind = int(rng.choice(len(KINDS) + 1, p=np.append(max(1 - shares.sum(), 0), shares))) - 1
        if kind < 0:
            continue
        styles, scene = _scene(rng, KINDS[kind])
        for style in styles:
            render = drawn(rng, scene, style)
            grey.append(cv2.cvtColor(render.picture, cv2.COLOR_RGB2GRAY))
            landmarks.append(render.landmarks)
            numbers.append(kind)
    samples = Samples(
        np.array(grey, np.uint8).reshape(-1, SIZE_PX, SIZE_PX),
        np.array(landmarks).reshape(-1, 68, 2),
        np.array(numbers, np.int64),
    )
    if path is not None:
        temporary = path.with_suffix(".tmp.npz")
        np.savez(temporary, **{name: getattr(samples, name) for name in _ARRAYS})
        temporary.replace(path)
    return samples


def _scene(rng: np.random.Generator, kind: str) -> tuple[list[str], Scene]:
    """A scene with a head of this kind, and the styles it is drawn in."""
    if kind == "figure":
        return [str(style) for style in rng.choice(_FLAT, _STYLES_A_HEAD, p=_FLAT_SHARES)], random_figure(rng, SIZE_PX)
    like = "caricature" if kind == "exaggerated" else kind
    styles = [random_style(rng, like) for _ in range(_STYLES_A_HEAD)]
    head = exaggerated_head(rng) if kind == "exaggerated" else None
    scene = random_scene(rng, like, styles[0] in ("flat", "outlined"), SIZE_PX, head=head)
    if kind == "cartoon" and rng.random() < _DRAWN_EYES:
        scene = with_drawn_eyes(rng, scene)
    return styles, scene
