"""Damaged model files by the thousand: what each loader makes of them, and for how long.

usage: python benchmarks/fuzz_models.py [--mutants 10000] [--formats gnm eos ...] [--seed 0]

The files are those of ``tests/model/loaders/layouts.py``, small but in the published layouts, damaged as in
``mutations.py`` there. All but ValueError and OSError, a crash of the process, or a file that takes more than five
seconds is a failure: its bytes are written to the folder that is printed. No pictures.
"""

import argparse
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.model.loaders import layouts
from tests.model.loaders.mutations import mutated
from toongeo.model import load_model, save_model

SLOW = 5.0  # seconds
KINDS = {"face3d": "bfm2009", "deep3d": "bfm2009", "flame_pickle": "flame", "flame_archive": "flame", "own": "toongeo"}


def fuzzed(name: str, mutants: int, seed: int, folder: Path) -> tuple[Counter, float, int]:
    """How often each outcome, the longest time in seconds, and how many failures."""
    face = layouts.Face()
    if name == "own":
        source = folder / "own.npz"
        save_model(load_model(layouts.deep3d(face, folder / "d.mat")), source)
    else:
        write, file = layouts.FILES[name]
        source = write(face, folder / file)
    content, rng = source.read_bytes(), np.random.default_rng(seed)
    found, longest, failures = Counter(), 0.0, 0
    for k in range(mutants):
        damaged = mutated(content, rng)
        source.write_bytes(damaged)
        (folder / "now").write_bytes(damaged)  # what a crash of the process leaves behind
        started = time.process_time()
        try:
            load_model(source, format=KINDS.get(name, name))
            outcome = "loaded"
        except (ValueError, OSError) as error:
            outcome = type(error).__name__
        except BaseException as error:
            outcome = f"FAILED {type(error).__name__}"
        seconds = time.process_time() - started
        if outcome.startswith("FAILED") or seconds > SLOW:
            failures += 1
            (folder / f"failure{k}").write_bytes(damaged)
        found[outcome] += 1
        longest = max(longest, seconds)
    return found, longest, failures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mutants", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--formats", nargs="+", default=[*layouts.FILES, "own"])
    arguments = parser.parse_args()
    print("| format | damaged files | loaded | refused | longest s | failures |\n|---|---|---|---|---|---|")
    for name in arguments.formats:
        folder = Path(tempfile.mkdtemp(prefix=f"fuzz-{name}-"))
        found, longest, failures = fuzzed(name, arguments.mutants, arguments.seed, folder)
        refused = found["ValueError"] + found["OSError"]
        row = f"{arguments.mutants} | {found['loaded']} | {refused} | {longest:.2f} | {failures}"
        print(f"| {name} | {row} |" + (f" {folder} {dict(found)}" if failures else ""), flush=True)


if __name__ == "__main__":
    main()
