"""Are the tests worth their name? Small faults are put into the library, one at a time, and tests must notice.

usage: python benchmarks/mutation.py --map [TESTS ...]
       python benchmarks/mutation.py --paths toongeo/geometry toongeo/render --sample 400 --seed 0
       python benchmarks/mutation.py --report

Faults are those of `mutants.py`, a seeded sample of all there are. Each runs in a copy of the tree, never in the
checkout: first the tests that mirror the file and its doctests, then those which the map says reach its line, the
fastest first, then the results on record. The first failing test ends it. `--map` runs tests once with coverage
(pytest-cov) and writes down which reach what, in the work folder; without a map the mirrored folder of tests is asked.
The log has a line for each fault; what is in it is not run again, so a run can be broken off and go on. `--again` runs
those that survived once more, when tests were added.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

from mutants import Mutant, mutants

ROOT = Path(__file__).resolve().parents[1]
PYTEST = [sys.executable, "-m", "pytest", "-q", "-x", "-n0", "-p", "no:cacheprovider", "--no-header", "--tb=no", "-rfE"]
PYTEST += ["-m", ""]  # the slow ones too
SURE = 10.0  # seconds of tests by the map that are tried; what then lives is mostly caught by none
# Which results on record a fault in a folder can change, as pytest's -k says it.
RECORDS = {"landmarks": "detection", "fit": "fit", "parse": "parse", "texture": "head or drawing"}
WALL = 20  # a machine may be busy: the limit is one of CPU seconds, that of the wall clock so many times as long
FAILED = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.M)
DURATION = re.compile(r"^([\d.]+)s (?:call|setup)\s+(.+)$", re.M)


class Tree:
    """A copy of the checkout in which faults are made."""

    def __init__(self, work: Path) -> None:
        self.work, self.root = work, work / "tree"
        shutil.rmtree(self.root, ignore_errors=True)
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
        for name in filter(None, listed.decode().split("\0")):
            if (ROOT / name).is_file():
                (self.root / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, self.root / name)
        shared = work / "shared"
        if (ROOT.parent / "shared").is_dir() and not shared.exists():
            shared.symlink_to(ROOT.parent / "shared")
        # Compiled once; by the hash of the source, since times are too coarse to tell a fault made a moment ago.
        compiled = [sys.executable, "-m", "compileall", "-q", "--invalidation-mode", "checked-hash", "toongeo"]
        subprocess.run(compiled, cwd=self.root, check=True)

    def run(self, command: list[str], limit: float) -> tuple[int, str, float]:
        """Exit code, output and CPU seconds of a command in the tree; negative if it took longer than the limit."""
        threads = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL")}
        environment = os.environ | threads | {"PYTHONPATH": str(self.root), "PYTHONDONTWRITEBYTECODE": "1"}
        seconds = int(limit) + 1
        before = _children_seconds()
        try:
            done = subprocess.run(
                command, cwd=self.root, env=environment, timeout=WALL * limit, check=False, text=True,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5)),
            )  # fmt: skip
            code, output = done.returncode, done.stdout
        except subprocess.TimeoutExpired:
            code, output = -1, ""
        return code, output, _children_seconds() - before


class TestMap:
    """Which tests reach a line, the fastest first."""

    def __init__(self, tree: Tree) -> None:
        self._tree, self._file, self._times = tree, tree.work / "tests.coverage", tree.work / "tests.seconds"
        self._data = None
        if self._file.exists():
            from coverage import CoverageData

            self._data = CoverageData(str(self._file))
            self._data.read()
        self._seconds = json.loads(self._times.read_text()) if self._times.exists() else {}

    @property
    def complete(self) -> bool:
        """Whether tests were mapped."""
        return self._data is not None

    def gather(self, tests: list[str]) -> None:
        """Run tests once, on all cores, and write down what they reach and how long they take."""
        command = [sys.executable, "-m", "pytest", "-q", "--cov=toongeo", "--cov-context=test", "--cov-report="]
        command += ["--durations=0", "--durations-min=0.005", "-p", "no:cacheprovider", *tests]
        code, output, seconds = self._tree.run(command, 36000)
        if code != 0:
            raise SystemExit(f"tests: expected them to pass without a fault, got\n{output[-2000:]}")
        found: Counter[str] = Counter()
        for duration, test in DURATION.findall(output):
            found[test] += float(duration)
        self._times.write_text(json.dumps(found))
        shutil.move(self._tree.root / ".coverage", self._file)
        print(f"{len(found)} tests mapped, {seconds:.0f} s CPU")

    def reaching(self, path: str, line: int) -> list[str]:
        """Tests that run a line, or any of its file if it runs at import, as far as they take `SURE` seconds."""
        if self._data is None:
            return []
        lines = self._data.contexts_by_lineno(str(self._tree.root / path))
        contexts = [c for c in lines.get(line, []) if c] or [c for found in lines.values() for c in found if c]
        tests = sorted({c.rsplit("|", 1)[0] for c in contexts}, key=lambda test: (self._seconds.get(test, 0.0), test))
        chosen, total = [], 0.0
        for test in tests:
            total += self._seconds.get(test, 0.0)
            if total > SURE:
                break
            chosen.append(test)
        return chosen


def stages(path: str, mutant: Mutant, tree: Tree, known: TestMap | None) -> list[list[str]]:
    """Tests that concern a fault, in the order in which they are asked; without a map only those written for it."""
    inside = Path(path).relative_to("toongeo")
    mirror = Path("tests") / inside.parent / f"test_{inside.stem}.py"
    folder = mirror.parent
    while not (tree.root / folder).is_dir():
        folder = folder.parent
    record = next((RECORDS[part] for part in inside.parts if part in RECORDS), "head")
    return [
        [str(mirror), path] if (tree.root / mirror).exists() else [path],
        [] if known is None else known.reaching(path, mutant.line) if known.complete else [str(folder)],
        ["tests/golden", "-k", record],
    ]


def verdict(path: str, mutant: Mutant, tree: Tree, known: TestMap | None, limit: float) -> dict[str, object]:
    """What became of a fault: killed by a test or by the clock, or survived."""
    file = tree.root / path
    source = file.read_bytes()
    asked, seconds, result = 0, 0.0, {"status": "survived", "test": ""}
    file.write_bytes(mutant.applied(source))
    try:
        for tests in filter(None, stages(path, mutant, tree, known)):
            code, output, used = tree.run([*PYTEST, *tests], limit)
            seconds, asked = seconds + used, asked + 1
            if code in (3, 4):
                raise SystemExit(f"{path}: tests did not start\n{output[-2000:]}")
            if code not in (0, 5):  # 5: there are none
                failed = FAILED.search(output)
                result = {"status": "killed" if code > 0 else "timeout", "test": failed[1] if failed else ""}
                break
    finally:
        file.write_bytes(source)
    return {**result, "stage": asked, "seconds": round(seconds, 1)}


def sample(root: Path, paths: list[str], count: int, seed: int) -> list[tuple[str, Mutant]]:
    """A seeded sample of all faults in the files under some paths, in random order."""
    files = {
        file for path in paths for file in ([root / path] if path.endswith(".py") else (root / path).rglob("*.py"))
    }
    every = [
        (file.relative_to(root).as_posix(), mutant) for file in sorted(files) for mutant in mutants(file.read_bytes())
    ]
    return random.Random(seed).sample(every, min(count, len(every)))


def logged(log: Path) -> list[dict[str, Any]]:
    """The last line of each fault."""
    lines = map(json.loads, log.read_text().splitlines() if log.exists() else ())
    return list({line["id"]: line for line in lines}.values())


def report(log: Path) -> str:
    """Rate of the killed, by folder and kind, and the survivors."""
    rows = logged(log)
    if not rows:
        return "no faults yet"
    dead = [row["status"] != "survived" for row in rows]
    lines = [f"{sum(dead)} of {len(rows)} caught: {100 * sum(dead) / len(rows):.1f} %"]
    lines.append(f"{sum(row['seconds'] for row in rows) / len(rows):.1f} s CPU a fault")
    for name in ("folder", "kind"):
        keys = [row["kind"] if name == "kind" else "/".join(row["path"].split("/")[:3]) for row in rows]
        all_of, dead_of = Counter(keys), Counter(key for key, was in zip(keys, dead, strict=True) if was)
        lines += ["", f"| {name} | caught | of |", "|---|---|---|"]
        lines += [f"| {key} | {dead_of[key]} | {all_of[key]} |" for key in sorted(all_of)]
    lines += ["", "survivors:"]
    lines += [
        f"  {row['path']}:{row['line']} {row['kind']}: {row['before']!r} -> {row['after']!r}"
        for row in sorted(rows, key=lambda row: (row["path"], row["line"]))
        if row["status"] == "survived"
    ]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--paths", nargs="+", default=["toongeo/geometry", "toongeo/pipeline", "toongeo/render"])
    parser.add_argument("--sample", type=int, default=400, metavar="N")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--limit", type=float, default=300.0, metavar="S", help="CPU seconds of one run of tests")
    parser.add_argument("--log", type=Path, help="mutation.jsonl in the work folder, if not given")
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "toongeo-mutation")
    parser.add_argument("--map", nargs="*", metavar="TESTS", help="run these tests (all) with coverage, and stop")
    parser.add_argument(
        "--part", default="0/1", metavar="K/N", help="every n-th fault from the k-th: processes share a log"
    )
    parser.add_argument("--again", action="store_true", help="run those that survived again")
    parser.add_argument("--report", action="store_true", help="only print what the log holds")
    options = parser.parse_args()
    options.log = options.log or options.work / "mutation.jsonl"
    if options.report:
        print(report(options.log))
        return
    options.work.mkdir(parents=True, exist_ok=True)
    tree = Tree(options.work.resolve())
    if options.map is not None:
        TestMap(tree).gather(options.map)
        return
    known = None if options.again else TestMap(tree)
    done = {row["id"] for row in logged(options.log) if not (options.again and row["status"] == "survived")}
    first, step = map(int, options.part.split("/"))
    for path, mutant in sample(tree.root, options.paths, options.sample, options.seed)[first::step]:
        name = f"{path}:{mutant.start}:{mutant.stop}:{mutant.after}"
        if name in done:
            continue
        row = {"id": name, "path": path, "line": mutant.line, "kind": mutant.kind, "before": mutant.before[:200],
               "after": mutant.after[:200], **verdict(path, mutant, tree, known, options.limit)}  # fmt: skip
        with options.log.open("a") as stream:
            stream.write(json.dumps(row) + "\n")
        print(f"{time.strftime('%H:%M')} {row['status']:<9}{row['seconds']:6.1f} s  {path}:{mutant.line} {mutant.kind}")
    print(report(options.log))


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
