"""Renders as arrays to train on, the same whatever the number of processes."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from renders.random_head import KINDS
from renders.render_face import drawn, random_style
from renders.scene import random_scene

from detector.workers import mapped
from toongeo.model.ibug68 import MIRROR

__all__ = ["SIZE_PX", "Samples", "mirrored", "rendered_samples"]

SIZE_PX = 256
_SHARES = (0.45, 0.30, 0.25)  # of KINDS
_STYLES_A_HEAD = 2  # a second style costs a fifth of a head
_CHUNK = 50  # heads


@dataclass(frozen=True, eq=False)
class Samples:
    """`grey` (n, 256, 256) uint8, `landmarks` (n, 68, 2) px, `kinds` (n,) index into KINDS, `yaw` (n,) degrees."""

    grey: NDArray[np.uint8]
    landmarks: NDArray[np.float64]
    kinds: NDArray[np.int64]
    yaw: NDArray[np.float64]


def rendered_samples(seed: int, heads: int, processes: int) -> Samples:
    """Two drawings of each of so many heads."""
    chunks = [(seed, k, min(k + _CHUNK, heads)) for k in range(0, heads, _CHUNK)]
    parts = mapped(_chunk, chunks, processes)
    names = ("grey", "landmarks", "kinds", "yaw")
    return Samples(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def mirrored(grey: NDArray[np.uint8], landmarks: NDArray[np.float64]) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """A picture and its points, left and right exchanged."""
    points = landmarks[MIRROR].copy()
    points[:, 0] = grey.shape[1] - 1 - points[:, 0]
    return np.ascontiguousarray(grey[:, ::-1]), points


def _chunk(chunk: tuple[int, int, int]) -> Samples:
    seed, first, last = chunk
    grey, landmarks, kinds, yaw = [], [], [], []
    for k in range(first, last):
        rng = np.random.default_rng([seed, k])  # of the head alone: chunks may run in any order
        kind = int(rng.choice(len(KINDS), p=_SHARES))
        styles = [random_style(rng, KINDS[kind]) for _ in range(_STYLES_A_HEAD)]
        scene = random_scene(rng, KINDS[kind], styles[0] in ("flat", "outlined"), SIZE_PX)
        for style in styles:
            render = drawn(rng, scene, style)
            grey.append(cv2.cvtColor(render.picture, cv2.COLOR_RGB2GRAY))
            landmarks.append(render.landmarks)
            kinds.append(kind)
            yaw.append(render.yaw)
    return Samples(np.array(grey), np.array(landmarks), np.array(kinds), np.array(yaw))
