"""Hostile files for every reader, and bad meshes for every function of geometry.

    python benchmarks/fuzz.py --inputs 100000 --meshes 10000   # about an hour on one core
    python benchmarks/fuzz.py --seconds 60                     # as many as fit

A reader promises a correct result, or a ValueError or OSError that names the argument and the cause, in bounded time
and memory; a function of geometry a finite result, or a ValueError. What is otherwise is printed with its number, by
which it is made again (``--only READER --first NUMBER --inputs 1 --keep``); exit code 1.
"""

import argparse
import os
import re
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

for name in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from fuzz_inputs import Target, bad_mesh, hostile, targets

from toongeo import geometry

MOST_SECONDS = 20.0
MOST_MB = 800  # that a reader may take, of files of some kB
NAMED = re.compile(r"^[A-Za-z_0-9]+(, [A-Za-z_0-9]+)*: ")


class Late(BaseException):
    """Past all handlers."""


def fault(target: Target, path: Path, content: bytes) -> str | None:
    """How a reader breaks its promise over a file; None if it keeps it."""
    path.write_bytes(content)

    def late(number: int, frame: Any) -> None:
        raise Late(f"more than {MOST_SECONDS} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, MOST_SECONDS)
    try:
        found = target.read(path)
        for array in target.arrays(found):
            if array.dtype.kind == "f" and np.isinf(array).any():
                return "gives infinity"
            if array.dtype.kind == "f" and not target.may_be_nan and np.isnan(array).any():
                return "gives NaN"
        return None
    except Late as error:
        return str(error)
    except (ValueError, OSError) as error:
        text = str(error)
        return (
            None if NAMED.match(text) or str(path) in text else f"names nothing: {type(error).__name__}: {text[:150]}"
        )
    except BaseException as error:
        return f"{type(error).__name__}: {str(error)[:150]}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def verbs() -> dict[str, Callable[[np.ndarray, np.ndarray], Any]]:
    """Every public function of geometry that takes a mesh."""
    g = geometry
    anchors = np.array([0, 1, 2])
    return {
        "vertex_normals": g.vertex_normals,
        "cotangent_laplacian": g.cotangent_laplacian,
        "uniform_laplacian": lambda V, F: g.uniform_laplacian(F, len(V)),
        "deformation_transfer": lambda V, F: g.deformation_transfer(V, V * [1, 1.1, 1], F, V * [1.2, 1, 1]),
        "laplacian_align": lambda V, F: g.laplacian_align(V, F, anchors, V[anchors] * 1.1),
        "self_intersections": g.self_intersections,
        "vertex_components": lambda V, F: g.vertex_components(F, len(V)),
        "catmull_clark": lambda V, F: g.catmull_clark(V, np.column_stack([F, F[:, :1]])),
        "deformation_gradients": lambda V, F: g.deformation_gradients(V, F, V * 1.1),
    }


def mesh_fault(verb: Callable[[np.ndarray, np.ndarray], Any], number: int) -> str | None:
    """How a function breaks its promise over a mesh."""
    V, F = bad_mesh(number)
    scale = np.abs(V[np.isfinite(V)]).max(initial=0.0)
    try:
        with np.errstate(all="ignore"):
            found = verb(V.copy(), F.copy())
    except ValueError as error:
        return None if NAMED.match(str(error)) else f"names nothing: {str(error)[:150]}"
    except BaseException as error:
        return f"{type(error).__name__}: {str(error)[:150]}"
    for array in found if isinstance(found, tuple) else (found,):
        values = np.asarray(getattr(array, "data", array))
        if values.dtype.kind == "f" and values.size and not np.isfinite(values).all():
            return f"gives NaN or infinity (of a mesh of size {scale:.0g})"
    return None


def run(inputs: int, meshes: int, seconds: float, only: str | None, first: int, keep: bool) -> int:
    """Print faults and counts; how many faults there are."""
    chosen = {name: target for name, target in targets().items() if only in (None, name)}
    started, faults, tried = time.monotonic(), [], Counter()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + -(-inputs // max(1, len(chosen)))):
            for name, target in chosen.items():
                if time.monotonic() > started + 0.7 * seconds:  # the rest is for meshes
                    break
                content, path = hostile(target, number, name), Path(folder) / f"file{target.suffix}"
                if keep:
                    (Path.cwd() / f"{name}{number}{target.suffix}").write_bytes(content)
                why = fault(target, path, content)
                tried[name] += 1
                if why:
                    faults.append((name, number, why))
    functions = {name: verb for name, verb in verbs().items() if only in (None, name)}
    for number in range(first, first + meshes):
        for name, verb in functions.items():
            if time.monotonic() > started + seconds:
                break
            tried[name] += 1
            if why := mesh_fault(verb, number):
                faults.append((name, number, why))
    print("| what | inputs | promises broken |\n|---|---|---|")
    for name, count in tried.items():
        print(f"| {name} | {count:,} | {sum(fault[0] == name for fault in faults)} |")
    print(f"| all | {sum(tried.values()):,} | {len(faults)} |")
    print(f"\nMemory at most {_peak_mb()} MB.")
    for name, number, why in faults[:200]:
        print(f"FAULT {name} {number}: {why}")
    return len(faults) + (_peak_mb() > MOST_MB)


def _peak_mb() -> int:
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10


def main() -> int:
    """Run."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--inputs", type=int, default=2000)
    parser.add_argument("--meshes", type=int, default=200, help="for each function")
    parser.add_argument("--seconds", type=float, default=3600.0)
    parser.add_argument("--only")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--keep", action="store_true", help="write the files here")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    return min(1, run(options.inputs, options.meshes, options.seconds, options.only, options.first, options.keep))


if __name__ == "__main__":
    sys.exit(main())
