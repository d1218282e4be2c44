"""Speed beside rivals in the same run, and how it grows with the size of the problem; memory; time to import.

usage: python benchmarks/speed.py               (tables; appends the ratios to ratio_history.csv)
       python benchmarks/speed.py --quick       (the same without the largest sizes; writes nothing)
       python benchmarks/speed.py --check       (compare with ratios.csv: exit code 1 if one is worse by more than 30 %)
       python benchmarks/speed.py --record      (write ratios.csv, and append to ratio_history.csv)

A ratio is the rival's CPU time over ours: the median over pairs of runs, one right after the other, so that what else
the machine does slows both alike. A ratio that fails the check is measured once more, with thrice as many pairs.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import argparse
import csv
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import cv2
import numpy as np
from speed_cases import CASES, Pair, anchors, grid, sparse_lu

from toongeo import LaplacianAligner, MorphableModel, default_model, fit_3dmm
from toongeo.app.bench.results.run_command import origin

RATIOS = Path(__file__).parent / "ratios.csv"  # what CI compares with
HISTORY = Path(__file__).parent / "ratio_history.csv"  # of all recorded runs; the site draws it
PAIRS = 5
WORSE = 0.7  # of the committed ratio: what noise does not reach, with a median of five pairs
SIZES = (3_000, 10_000, 30_000, 100_000, 300_000)
RIVAL_SIZE = 30_000  # beyond it the general solver takes minutes and gigabytes
MODES = (5, 20, 50, 100, 200)
FACES = (1, 10, 100, 1000)


def seconds(run: Callable[[], object]) -> float:
    started = time.process_time()
    run()
    return time.process_time() - started


def ratio(pair: Pair, pairs: int = PAIRS) -> tuple[float, float]:
    """Median ratio, and the least seconds of ours."""
    ours, _, rival = pair
    ours(), rival()
    runs = [(seconds(ours), seconds(rival)) for _ in range(pairs)]
    return median(theirs / own for own, theirs in runs), min(own for own, _ in runs)


def committed() -> dict[str, float]:
    with RATIOS.open(newline="", encoding="utf-8") as stream:
        return {row["case"]: float(row["ratio"]) for row in csv.DictReader(stream)}


def check() -> int:
    worse = 0
    for name, wanted in committed().items():
        pair = CASES[name]()
        found, _ = ratio(pair)
        if found < WORSE * wanted:
            found, _ = ratio(pair, 3 * PAIRS)
        failed = found < WORSE * wanted
        worse += failed
        print(f"{'WORSE' if failed else 'ok'}: {name}: {found:.2f} times {pair[1]}, committed {wanted:.2f}", flush=True)
    return int(worse > 0)


def record() -> None:
    found = {name: ratio(case(), 3 * PAIRS)[0] for name, case in CASES.items()}
    with RATIOS.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["case", "ratio"])
        writer.writerows([name, f"{value:.2f}"] for name, value in found.items())
    append_to_history(found)


def append_to_history(ratios: dict[str, float]) -> None:
    about = origin(HISTORY.parents[1])
    with HISTORY.open("a", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerows([about["date"], about["commit"], name, f"{value:.2f}"] for name, value in ratios.items())


def table(*columns: str) -> None:
    print("\n| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))


def rivals() -> dict[str, float]:
    table("case", "CPU ms", "rival", "rival's time / ours")
    ratios = {}
    for name, case in CASES.items():
        pair = case()
        ratios[name], own = ratio(pair)
        print(f"| {name} | {1e3 * own:.1f} | {pair[1]} | {ratios[name]:.2f} |", flush=True)
    return ratios


def by_vertices(sizes: tuple[int, ...]) -> None:
    table("vertices", "align, new mesh: CPU ms", "same mesh: CPU ms", "scipy splu, new mesh: CPU ms", "ratio")
    for size in sizes:
        V, F = grid(size)
        fixed = anchors(len(V))
        targets = V[fixed] + 0.01
        aligner = LaplacianAligner(V, F, fixed)
        new = min(seconds(lambda: LaplacianAligner(V, F, fixed).align(targets)) for _ in range(2))  # noqa: B023
        same = min(seconds(lambda: aligner.align(targets)) for _ in range(3))  # noqa: B023
        if size <= RIVAL_SIZE:
            rival = seconds(lambda: sparse_lu(V, F, fixed, targets))  # noqa: B023
            beside = f"{1e3 * rival:.0f} | {rival / new:.1f}"
        else:
            beside = "not run | "
        print(f"| {len(V):,} | {1e3 * new:.0f} | {1e3 * same:.1f} | {beside} |", flush=True)


def by_modes(counts: tuple[int, ...]) -> None:
    """Fits of landmarks that such a model shows, with so many modes, mixed at random of the template's."""
    table("identity modes", "fit of 68 landmarks: CPU ms")
    whole, rng = default_model(), np.random.default_rng(0)
    for count in counts:
        mixed = rng.standard_normal((count, len(whole.identity))) / np.sqrt(len(whole.identity))
        modes = np.tensordot(mixed, whole.identity, 1).astype(np.float32)
        model = MorphableModel.from_arrays(whole.mean, whole.faces, identity=modes, landmarks=whole.landmarks)
        shape = model.vertices(rng.standard_normal(count) / np.sqrt(count))[whole.landmarks]
        landmarks = shape[:, :2] * [2.0, -2.0] + 256
        fit_3dmm(None, landmarks, model=model)
        took = min(seconds(lambda: fit_3dmm(None, landmarks, model=model)) for _ in range(3))  # noqa: B023
        print(f"| {count} | {1e3 * took:.0f} |", flush=True)


def by_faces(counts: tuple[int, ...]) -> None:
    table("faces of one topology", "align all: CPU ms", "a face: CPU ms")
    V, F = grid(10_000)
    fixed = anchors(len(V))
    for count in counts:

        def all_of_them(count: int = count) -> None:
            aligner = LaplacianAligner(V, F, fixed)
            for k in range(count):
                aligner.align(V[fixed] + 1e-4 * k)

        took = seconds(all_of_them)
        print(f"| {count} | {1e3 * took:.0f} | {1e3 * took / count:.1f} |", flush=True)


MEASURED = {
    "bare Python": "pass",
    "import numpy, scipy.sparse, cv2, igl": "import numpy, scipy.sparse, cv2, igl",
    "import toongeo": "import toongeo",
    "the template": "import toongeo; toongeo.default_model()",
    "a fit": "import toongeo as t; t.fit_3dmm(None, t.read_landmarks('examples/portraits/blue_girl.pts'))",
    "a whole avatar": "import toongeo as t; p = 'examples/portraits/blue_girl'; "
    "t.make_avatar(t.read_image(p + '.png'), t.read_landmarks(p + '.pts'))",
}


def processes() -> None:
    table("in a new process", "CPU s", "memory at its peak, MB")
    # Of Linux: what getrusage tells of memory is at least that of the process which started this one.
    told = (
        "import time; peak = next(x for x in open('/proc/self/status') if x.startswith('VmHWM')); "
        "print(time.process_time(), float(peak.split()[1]) / 1024)"
    )
    for name, code in MEASURED.items():
        runs = []
        for _ in range(3):
            done = subprocess.run(
                [sys.executable, "-c", f"{code}\n{told}"],
                cwd=RATIOS.parents[1],
                capture_output=True,
                text=True,
                check=True,
            )
            runs.append([float(word) for word in done.stdout.split()])
        cpu, memory = np.min(runs, axis=0)
        print(f"| {name} | {cpu:.2f} | {memory:.0f} |", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser()
    for name in ("quick", "check", "record"):
        parser.add_argument(f"--{name}", action="store_true")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    if options.check:
        return check()
    if options.record:
        record()
        return 0
    fewer = slice(0, 2 if options.quick else None)
    ratios = rivals()
    if not options.quick:
        append_to_history(ratios)
    by_vertices(SIZES[fewer])
    by_modes(MODES[fewer])
    by_faces(FACES[fewer])
    processes()
    return 0


if __name__ == "__main__":
    sys.exit(main())
