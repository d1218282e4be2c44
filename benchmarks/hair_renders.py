"""Hair masks and trust in them on fresh renders, hats and bald heads among them.

usage: PYTHONPATH=.:data_templates/build:data_templates/build/hair python benchmarks/hair_renders.py [COUNT]

The renderers are those that the trees learnt from, the seeds are others. The rival is to trust every mask.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import sys

sys.path.append(sys.path.pop(0))  # of two modules `noise` that of the renderers

import numpy as np
from random_picture import HAIR, HAT, random_picture
from rendered_face import rendered_face

from toongeo import find_hair
from toongeo.model import default_model

SEED = 31  # not that of the training
LEAST = 0.002  # of the picture: below there is no hair, or no hat
GOOD, BAD = 0.85, 0.7


def overlap(one: np.ndarray, two: np.ndarray) -> float:
    union = (one | two).sum()
    return float((one & two).sum() / union) if union else 1.0


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 120
    rows = []
    for k in range(count):
        rng = np.random.default_rng([SEED, k])
        picture = random_picture(rng, default_model()) if k % 2 else rendered_face(rng)
        found = find_hair(picture.img, picture.landmarks)
        hair, hat = picture.labels == HAIR, picture.labels == HAT
        labelled = found.hat is not None and overlap(found.hat, hat) > 0.5
        rows.append((found.trusted, overlap(found.mask, hair), hair.mean() > LEAST, hat.mean() > LEAST, labelled))
    trusted, found, hairy, hatted, told = (np.array(column) for column in zip(*rows, strict=True))
    print(f"{count} renders, {hairy.sum()} with hair, {hatted.sum()} with hats")
    for name, kept in (("all", np.ones(count, bool)), ("trusted", trusted)):
        print(
            f"{name}: {kept.sum()}, mean {found[kept].mean():.3f}, {GOOD} and more {(found[kept] >= GOOD).sum()}, "
            f"below {BAD} {(found[kept] < BAD).sum()}, with hats {(kept & hatted).sum()}, bald {(kept & ~hairy).sum()}"
        )
    print(f"hats told from hair: {(told & hatted).sum()} of {hatted.sum()}")


if __name__ == "__main__":
    main()
