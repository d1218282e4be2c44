"""The chosen priors: how random faces are drawn from the artists' morph targets.

These are choices, not statistics of scans: a broad mixture of ancestry, sex, age, muscle and weight macros,
and small independent amounts of the detail modifiers, with the two sides of the face tied together but for a
little asymmetry.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from source import MPFB, Floats, Source

DETAIL_FOLDERS = ("head", "eyes", "nose", "mouth", "chin", "cheek", "forehead", "eyebrows", "ears", "neck")
# Rigid offsets say nothing about shape, and age is handled by the macros.
_SKIP = ("head/head-trans", "neck/neck-trans", "neck/measure", "head/head-age")
_OPPOSITE = (
    ("decr", "incr"),
    ("down", "up"),
    ("in", "out"),
    ("backward", "forward"),
    ("concave", "convex"),
    ("compress", "uncompress"),
)
# Standard deviation of a detail modifier, whose artist range is [-1, 1].
_SIGMA = {
    "head": 0.176, "eyes": 0.24, "nose": 0.24, "mouth": 0.24, "chin": 0.224,
    "cheek": 0.256, "forehead": 0.28, "eyebrows": 0.32, "ears": 0.24, "neck": 0.2,
}  # fmt: skip
_SIDE_SIGMA = 0.06
_ANCESTRY = ("african", "asian", "caucasian")
_AGES = {"baby": 0.0, "child": 0.1875, "young": 0.5, "old": 1.0}


@dataclass(frozen=True)
class Modifier:
    """A detail slider: `negative` (or None when it has one end only) and `positive` target names."""

    negative: str | None
    positive: str

    @property
    def group(self) -> str:
        """Name shared by the left and the right slider."""
        folder, file = self.positive.split("/")
        return f"{folder}/{file[2:] if file[:2] in ('l-', 'r-') else file}"


def modifiers(source: Source) -> list[Modifier]:
    """All detail sliders of the wheel that shape the head."""
    names = [f"{d}/{n}" for d in DETAIL_FOLDERS for n in source.names(f"{MPFB}/targets/{d}")]
    names = [n for n in names if not n.startswith(_SKIP)]
    sliders = []
    for name in names:
        ends = [(a, b) for a, b in _OPPOSITE if name.endswith(("-" + a, "-" + b))]
        if not ends:
            sliders.append(Modifier(None, name))
            continue
        low, high = ends[0]
        if name.endswith("-" + low) and name[: -len(low)] + high in names:
            sliders.append(Modifier(name, name[: -len(low)] + high))
        elif not (name.endswith("-" + high) and name[: -len(high)] + low in names):
            sliders.append(Modifier(None, name))
    return sliders


def asymmetries(source: Source) -> list[str]:
    """The one-sided `asym` targets of the head."""
    return [f"asym/{n}" for n in source.names(f"{MPFB}/targets/asym") if not n.startswith("asymm-")]


def macro_weights(
    ancestry: tuple[float, ...] = (1 / 3, 1 / 3, 1 / 3),
    gender: float = 0.5,
    age: float = 0.6,
    muscle: float = 0.5,
    weight: float = 0.5,
) -> dict[str, float]:
    """Weights of the macro targets; `gender` 1 is male, `age` 0.5 is 25 years, 1 is 90, all sliders in [0,
    1]."""
    ages = list(_AGES)
    position = np.interp(age, list(_AGES.values()), range(len(ages)))
    first = min(int(position), len(ages) - 2)
    blend = {ages[first]: 1 - (position - first), ages[first + 1]: position - first}

    def ends(value: float) -> dict[str, float]:
        return {
            "min": max(0.0, 1 - 2 * value),
            "average": 1 - abs(2 * value - 1),
            "max": max(0.0, 2 * value - 1),
        }

    out = {}
    for sex, sex_weight in (("male", gender), ("female", 1 - gender)):
        for years, years_weight in blend.items():
            both = sex_weight * years_weight
            for people, share in zip(_ANCESTRY, ancestry, strict=True):
                out[f"macrodetails/{people}-{sex}-{years}"] = both * share
            for m, mw in ends(muscle).items():
                for w, ww in ends(weight).items():
                    out[f"macrodetails/universal-{sex}-{years}-{m}muscle-{w}weight"] = both * mw * ww
    return {name: value for name, value in out.items() if value}


def random_face(rng: np.random.Generator, sliders: list[Modifier], asym: list[str]) -> dict[str, float]:
    """Target weights of one random face."""
    teen = rng.random() < 0.12
    age = rng.uniform(0.25, 0.5) if teen else 0.5 + 0.5 * rng.beta(1.1, 1.8)
    muscle, weight = np.clip(rng.normal(0.5, [0.18, 0.2]), 0, 1)
    face = macro_weights(tuple(rng.dirichlet([0.45] * 3)), rng.beta(0.35, 0.35), age, muscle, weight)
    shared: dict[str, float] = {}
    for slider in sliders:
        if slider.negative is None:
            if slider.group not in shared:
                shared[slider.group] = abs(rng.normal(0, 0.22)) if rng.random() < 0.3 else 0.0
            amount = shared[slider.group]
        else:
            if slider.group not in shared:
                shared[slider.group] = rng.normal(0, _SIGMA[slider.group.split("/")[0]])
            amount = shared[slider.group] + rng.normal(0, _SIDE_SIGMA) * (slider.group != slider.positive)
        amount = float(np.clip(amount, -1, 1))
        name = slider.positive if amount > 0 else slider.negative
        if name is not None:
            face[name] = abs(amount)
    for name in asym:
        if rng.random() < 0.25:
            face[name] = abs(rng.normal(0, 0.15))
    return face


def blend(faces: list[dict[str, float]], source: Source, vertices: Floats, ids: np.ndarray) -> Floats:
    """Vertices (len(faces), len(ids), 3) in decimetres of faces given by their target weights."""
    names = sorted({name for face in faces for name in face})
    column = {name: k for k, name in enumerate(names)}
    weights = np.zeros((len(faces), len(names)))
    for row, face in zip(weights, faces, strict=True):
        for name, value in face.items():
            row[column[name]] = value
    deltas = np.array([source.target(name, len(vertices))[ids].ravel() for name in names])
    return vertices[ids] + (weights @ deltas).reshape(len(faces), len(ids), 3)
