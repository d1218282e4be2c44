"""Random heads: people, caricatures and cartoons, with an expression and a gaze."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from renders.canvas import between
from renders.template import template

__all__ = ["KINDS", "Head", "finished_head", "random_expression", "random_head"]

KINDS = ("person", "caricature", "cartoon")
# By kind: spread of the identity in standard deviations (low, high), and of the magnification of parts (log).
_SPREAD = {"person": (0.7, 1.1), "caricature": (1.0, 2.2), "cartoon": (0.3, 1.4)}
_MAGNIFIED = {"person": 0.12, "caricature": 0.30, "cartoon": 0.35}
# What caricaturists and cartoonists make larger or smaller than it is: means of the log of the scale.
_EYES = {"person": 0.0, "caricature": 0.0, "cartoon": 0.18}
_NOSE = {"person": 0.0, "caricature": 0.12, "cartoon": -0.15}
_MOUTH = {"person": 0.0, "caricature": 0.12, "cartoon": -0.10}
_EYE, _NOSE_SPAN, _LIPS = (range(36, 42), range(42, 48)), range(29, 36), range(48, 60)


@dataclass(frozen=True, eq=False)
class Head:
    """`vertices` (n + eyes, 3) mm of head and eyeballs, `gaze_angles` (n + eyes,) rad from the pupil's middle (9 on
    the head), `iris_scale` of the iris' radius, and the kind."""

    vertices: NDArray[np.float64]
    gaze_angles: NDArray[np.float64]
    iris_scale: float
    kind: str


def random_head(rng: np.random.Generator, kind: str) -> Head:
    """A head of this kind."""
    model = template().model
    principal = model.prior.n_principal
    mean = model.prior.mean[:principal] * between(rng, 0, 1)
    identity = np.zeros(len(model.identity))
    identity[:principal] = mean + rng.normal(size=principal) * between(rng, *_SPREAD[kind])
    identity[30:] *= between(rng, 0.3, 1)  # the small modes are noise when they are exaggerated
    vertices = model.vertices(identity, random_expression(rng, kind))
    return finished_head(rng, kind, vertices, [eye.placed(identity) for eye in model.eyes])


def finished_head(rng: np.random.Generator, kind: str, vertices: NDArray[np.float64], eyeballs) -> Head:
    """The head of a face (n, 3) mm with eyeballs (centre, radius): a gaze, and parts out of proportion."""
    gaze = np.radians(rng.normal(size=2) * (12, 8))
    direction = np.array([np.sin(gaze[0]), np.sin(gaze[1]), np.cos(gaze[0])])
    direction /= np.linalg.norm(direction)
    parts, angles = [vertices], [np.full(len(vertices), 9.0)]
    for eye, (centre, radius) in zip(template().model.eyes, eyeballs, strict=True):
        parts.append(eye.vertices * max(radius, 6.0) + centre)
        cosine = eye.vertices @ direction / np.linalg.norm(eye.vertices, axis=1)
        angles.append(np.arccos(np.clip(cosine, -1, 1)))
    iris_scale = {"person": 1.0, "caricature": between(rng, 0.9, 1.2), "cartoon": between(rng, 0.9, 1.7)}[kind]
    whole = np.vstack(parts)
    if rng.random() < (0.4 if kind == "person" else 0.9):
        whole, iris_scale = _magnified(rng, whole, kind, iris_scale)
    if kind != "person" and rng.random() < 0.3:  # a crooked mouth and jaw
        whole[:, 0] += np.exp(-0.5 * ((whole[:, 1] + 60) / 45) ** 2) * rng.normal(0, 6)
    return Head(whole, np.concatenate(angles), iris_scale, kind)


def _magnified(
    rng: np.random.Generator, vertices: NDArray[np.float64], kind: str, iris_scale: float
) -> tuple[NDArray[np.float64], float]:
    """Parts scaled by Gaussian windows, then the proportions of the whole."""
    model, level, out = template().model, _MAGNIFIED[kind], vertices.copy()

    def middle(points) -> NDArray[np.float64]:
        return out[model.landmarks[list(points)]].mean(0)

    def scale(centre, span: float, factors) -> None:
        offset = out - centre
        window = np.exp(-0.5 * np.einsum("nk,nk->n", offset, offset) / span**2)[:, None]
        out[:] = out + window * offset * (np.asarray(factors) - 1)

    def factor(mean: float, spread: float) -> float:
        return float(np.exp(rng.normal(mean, spread)))

    manga = kind == "cartoon" and rng.random() < 0.35
    size, aspect = factor(*((0.45, 0.15) if manga else (_EYES[kind], 0.8 * level))), factor(0, 0.5 * level)
    if manga:
        iris_scale = between(rng, 1.2, 1.9)
    for eye in _EYE:
        sides = size * between(rng, 0.97, 1.03), size * aspect * between(rng, 0.95, 1.05), max(size, 0.8)
        scale(middle(eye) - [0, 0, 8], 24.0, sides)
    size = factor(_NOSE[kind] - 0.4 * manga, level)
    scale(middle(_NOSE_SPAN), 24.0, [size * factor(0, 0.5 * level) for _ in range(3)])
    size = factor(_MOUTH[kind], 0.9 * level)
    wide = 35.0 if kind == "caricature" else 28.0
    scale(middle(_LIPS), wide, [size * factor(0, 0.6 * level), size * factor(0, 0.5 * level), size])
    size = factor(0, level)
    chin = out[model.landmarks[8]] + [0, 0, 20]
    scale(chin, 36.0, [size * factor(0, 0.6 * level), size, size * factor(0, 0.5 * level)])
    scale([0, 80, -60], 60.0, factor(0, 0.8 * level))
    size = factor(0, level)
    for side in ("ear_left", "ear_right"):
        scale(model.mean[model.region(side)].mean(0), 26.0, size)
    out[:, 1] *= factor(0, 0.35 * level)
    out[:, 0] *= factor(0, 0.25 * level) * np.exp(rng.normal(0, 0.5 * level) * np.clip(-out[:, 1] / 110, -0.8, 1.2))
    for points, span in ((_NOSE_SPAN, 28.0), (_LIPS, 30.0), (range(36, 48), 40.0)):
        offset = out - middle(points)
        window = np.exp(-0.5 * (offset[:, 1] / span) ** 2 - 0.5 * (offset[:, 2] / 80) ** 2)
        out[:, 1] += window * rng.normal(0, 28 * level)
    return out, iris_scale


def random_expression(rng: np.random.Generator, kind: str) -> NDArray[np.float64]:
    """Weights (e,): a few units at random, and often a smile, an open mouth, a frown."""
    names = template().model.expression_names
    weights = np.zeros(len(names))

    def add(name: str, value: float) -> None:
        for side in ("", "Left", "Right"):
            if name + side in names:
                weights[names.index(name + side)] += value * (1 if not side else between(rng, 0.85, 1.15))

    named = template().model.n_named
    for k in rng.choice(named, rng.integers(0, 5), replace=False):
        if names[k] != "tongueOut":
            weights[k] += between(rng, 0.1, 0.8)
    if rng.random() < 0.4:
        weights[named:] = rng.normal(0, 0.25, len(names) - named)
    mood = rng.random()
    if mood < 0.5:
        strength = between(rng, 0.3, 1.1) * (1.4 if kind == "caricature" else 1)
        add("mouthSmile", strength)
        add("mouthUpperUp", strength * between(rng, 0, 0.7))
        add("mouthLowerDown", strength * between(rng, 0, 0.8))
        add("cheekSquint", between(rng, 0, 0.8))
        add("eyeSquint", between(rng, 0, 0.6))
        add("jawOpen", rng.choice([0, between(rng, 0, 0.45)]))
    elif mood < 0.62:
        add("jawOpen", between(rng, 0.1, 1.0))
        add("eyeWide", between(rng, 0, 0.8))
        add("browInnerUp", between(rng, 0, 0.8))
    elif mood < 0.7:
        add("mouthFrown", between(rng, 0.2, 1))
        add("browDown", between(rng, 0, 1))
        add("mouthPress", between(rng, 0, 0.6))
    elif mood < 0.76:
        add("mouthPucker", between(rng, 0.2, 0.9))
    for name, chance, low, high in (
        ("eyeBlink", 0.12, 0.3, 0.9),
        ("browDown", 0.2, 0, 0.9),
        ("browOuterUp", 0.15, 0, 0.9),
        ("eyeWide", 0.35, 0, 1),
    ):
        if rng.random() < chance:
            add(name, between(rng, low, high))
    return np.clip(weights, -0.6, 1.7 if kind == "caricature" else 1.2)
