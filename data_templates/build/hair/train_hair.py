"""Trees that tell hair and hats, from pictures of random heads: makes ``data_templates/hair.npz``.

usage: OPENBLAS_NUM_THREADS=1 PYTHONPATH=.:data_templates/build \\
       python data_templates/build/hair/train_hair.py [--pictures N] [--out FILE]

Takes about ten minutes on one core and 4 GB. No picture of anyone is looked at, only renders of the template. The same
machine gives the same bytes. It prints how the trees do on the half of the renders that they were not grown on.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from grow_trees import grow_trees
from random_picture import random_picture
from rendered_face import rendered_face
from training_rows import TrainingRows, training_rows

from toongeo.model import default_model
from toongeo.pipeline.parse.hair.boosted_trees import BoostedTrees

OUT = Path(__file__).parents[2] / "hair.npz"
SEED = 7
ROUNDS, DEPTH = 60, 5
PER_PICTURE = 300  # superpixels: so that large pictures do not count more


def rows_of(seed: int) -> TrainingRows:
    """Two renderers take turns: this folder's has more kinds of hair, hats and grounds, the other better faces."""
    rng = np.random.default_rng([SEED, seed])
    return training_rows(random_picture(rng, default_model()) if seed % 2 else rendered_face(rng))


def sampled(numbers: list[np.ndarray], cases: list[TrainingRows], rng: np.random.Generator):
    """Rows and shares of a few superpixels of each picture."""
    X, Y = [], []
    for one, case in zip(numbers, cases, strict=True):
        chosen = rng.permutation(len(one))[:PER_PICTURE]
        X.append(one[chosen])
        Y.append(case.shares[chosen])
    return np.vstack(X), np.vstack(Y)


def grown(numbers: list[np.ndarray], cases: list[TrainingRows], stage: int) -> tuple[BoostedTrees, list[np.ndarray]]:
    """Trees of all pictures, and for each picture what trees of the other half say of it."""
    rng = np.random.default_rng([SEED, stage])
    guesses: list[np.ndarray] = [np.empty(0)] * len(cases)
    for half in (0, 1):
        other = slice(1 - half, None, 2)
        trees = grow_trees(*sampled(numbers[other], cases[other], rng), rounds=ROUNDS, depth=DEPTH, rng=rng)
        for k in range(half, len(cases), 2):
            guesses[k] = trees(numbers[k])
    overlap = [overlap_of(guess, case) for guess, case in zip(guesses, cases, strict=True) if hairy(case)]
    print(f"stage {stage}: overlap of hair and hats in pictures not grown on: {np.mean(overlap):.3f}", flush=True)
    return grow_trees(*sampled(numbers, cases, rng), rounds=ROUNDS, depth=DEPTH, rng=rng), guesses


def hairy(case: TrainingRows) -> bool:
    return bool(case.shares[:, 1:].sum() > 5)


def overlap_of(guess: np.ndarray, case: TrainingRows) -> float:
    found, true = guess[:, 1:].sum(1) > 0.5, case.shares[:, 1:].sum(1) > 0.5
    area = case.area
    return float(area[found & true].sum() / max(area[found | true].sum(), 1))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=int, default=960)
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    first, second = trained([rows_of(k) for k in range(options.pictures)])
    arrays = {
        f"{stage}_{name}": getattr(trees, name)
        for stage, trees in (("first", first), ("second", second))
        for name in ("features", "thresholds", "leaves", "start")
    }
    np.savez_compressed(options.out, **arrays)


def trained(cases: list[TrainingRows]) -> tuple[BoostedTrees, BoostedTrees]:
    """Both sets of trees; the second learns from what the first says of pictures that it was not grown on."""
    numbers = [case.numbers for case in cases]
    first, guesses = grown(numbers, cases, 1)
    numbers = [np.column_stack([c.numbers, c.context(guess)]) for c, guess in zip(cases, guesses, strict=True)]
    return first, grown(numbers, cases, 2)[0]


if __name__ == "__main__":
    main()
