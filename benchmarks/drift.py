"""Whether a process that goes on for long grows.

    python benchmarks/drift.py                          # 1,000 fits and 200 avatars
    python benchmarks/drift.py --fits 100 --avatars 0

Prints memory in use (MB) after a tenth of them, when all caches are warm, and at the end; exit code 1 if it grew by
more than 20 MB.
"""

import argparse
import gc
import os
import sys
from collections.abc import Callable
from pathlib import Path

for name in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")

import numpy as np
from pictures import FOLDER, roles

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import toongeo as tg

MOST_MB = 20.0
PORTRAIT = FOLDER / "moustache_man"


def held_mb() -> float:
    """Of this process, now; on Linux."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def drift(work: Callable[[int], object], count: int) -> tuple[float, float]:
    """Memory after a tenth of the work, at least five times, and after all of it."""
    warm = max(5, count // 10)
    for k in range(warm):
        work(k)
    before = held_mb()
    for k in range(warm, count):
        work(k)
    return before, held_mb()


def works() -> dict[str, Callable[[int], object]]:
    """What is done again and again, each time with other landmarks."""
    img, landmarks = tg.read_image(f"{PORTRAIT}.png"), tg.read_landmarks(f"{PORTRAIT}.pts")

    def moved(k: int) -> np.ndarray:
        return landmarks + np.random.default_rng(k).normal(0, 0.5, landmarks.shape)

    return {
        "fits": lambda k: tg.fit_3dmm(img, moved(k)),
        "avatars": lambda k: tg.make_avatar(img, moved(k), texture_size=128),
    }


def main() -> int:
    """Print and judge."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fits", type=int, default=1000)
    parser.add_argument("--avatars", type=int, default=200)
    options = parser.parse_args()
    grown = 0.0
    for name, work in works().items():
        count = getattr(options, name)
        if count:
            before, after = drift(work, count)
            print(f"{count:6} {name:8} {before:7.1f} MB -> {after:7.1f} MB")
            grown = max(grown, after - before)
    print(roles("drift", [PORTRAIT.name]))
    return int(grown > MOST_MB)


if __name__ == "__main__":
    sys.exit(main())
