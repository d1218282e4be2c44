"""A batch that everything happens to: corrupt pictures, a killed worker, two interruptions; and what backends give.

    python benchmarks/batch.py --pictures 500             # pictures are drawn from the template, in styles
    python benchmarks/batch.py --pictures 500 --scaling   # pictures a minute with one and with two workers instead

Draws heads, spoils one in twenty, and makes avatars of them: by two workers, one of which is killed, in a batch that
is interrupted twice and resumed; those of a folder of fifty once more one after the other, and by dask. Prints what
must be so and whether it is; exit code 1 if something is not.
"""

import argparse
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

for name in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{name}_NUM_THREADS", "1")

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "data_templates" / "build")]

from renders.render_face import render_face

from toongeo.batch import read_manifest
from toongeo.io import encode_image, write_landmarks

CORRUPT_ONE_IN = 20
SIZE = 256  # px of the pictures
SEED = 2200


def draw(folder: Path, count: int) -> set[str]:
    """Random faces in all styles and their landmarks; the names of those that are spoiled."""
    corrupt = set()
    for k in range(count):
        render = render_face(np.random.default_rng([SEED, k]), size=SIZE)
        content, name = encode_image(render.picture), f"{k // 50:03}/head{k:05}"
        if k % CORRUPT_ONE_IN == 7:
            corrupt.add(f"{name}.png")
            content = content[: len(content) // 2] if k % 2 else b"not a picture"
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}.png").write_bytes(content)
        write_landmarks(folder / f"{name}.pts", render.landmarks)
    return corrupt


def command(folder: Path, output: Path, *more: str) -> list[str]:
    """The batch as a user has it, with small files."""
    small = ["--texture-size", "128", "--no-hair"]
    return [sys.executable, "-m", "toongeo", "batch", str(folder), "-o", str(output), *small, *more]


def digests(output: Path) -> dict[str, str]:
    """SHA-256 of every avatar."""
    found = sorted(output.rglob("*.glb"))
    return {path.relative_to(output).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in found}


def made(output: Path) -> int:
    """Lines of the manifest that tell of a picture."""
    path = output / "manifest.jsonl"
    return path.read_text().count('"picture"') if path.exists() else 0


def disturbed(folder: Path, output: Path, count: int) -> None:
    """Two workers; one killed after a fifth; interrupted after two and three fifths, and resumed."""
    disturbances = [(0.2, "kill"), (0.4, signal.SIGINT), (0.6, signal.SIGTERM)]
    process = subprocess.Popen(command(folder, output, "--workers", "2", "--resume"), cwd=ROOT)
    while process.poll() is None:
        time.sleep(0.1)
        if disturbances and made(output) >= disturbances[0][0] * count:
            _, what = disturbances.pop(0)
            if what == "kill":
                os.kill(a_worker(output), signal.SIGKILL)
                continue
            process.send_signal(what)
            assert process.wait() == 130, "an interrupted batch says so"
            assert not list(output.rglob("*.tmp")), "an interrupted batch leaves no part of a file"
            process = subprocess.Popen(command(folder, output, "--workers", "2", "--resume"), cwd=ROOT)
    assert process.returncode == 0 and not disturbances, "the batch ended before all was done to it"


def a_worker(output: Path) -> int:
    """Number of a process that wrote the latest line."""
    return int(json.loads((output / "manifest.jsonl").read_text().splitlines()[-1])["worker"])


def scaling(folder: Path, base: Path, count: int) -> None:
    """Pictures a minute by the number of workers."""
    print("| workers | s | pictures a minute | times |\n|---|---|---|---|")
    first = 0.0
    for workers in (1, 2):
        started = time.perf_counter()
        subprocess.run(command(folder, base / f"scaling{workers}", "--workers", str(workers)), cwd=ROOT, check=True)
        rate = 60 * count / (time.perf_counter() - started)
        first = first or rate
        print(f"| {workers} | {60 * count / rate:.0f} | {rate:.1f} | {rate / first:.2f} |")


def main() -> int:
    """Print what is so."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=int, default=60)
    parser.add_argument("--scaling", action="store_true")
    parser.add_argument("--again", type=int, default=1, help="folders of fifty that are made again (default 1)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        base = Path(place)
        corrupt = draw(base / "in", options.pictures)
        if options.scaling:
            scaling(base / "in", base, options.pictures)
            return 0
        disturbed(base / "in", base / "disturbed", options.pictures)
        rough, records = digests(base / "disturbed"), read_manifest(base / "disturbed")
        good = {f"{name.removesuffix('.png')}.glb" for name in records} - {
            f"{name.removesuffix('.png')}.glb" for name in corrupt
        }
        refused = {name for name, record in records.items() if record["status"] == "refused"}
        checks = {
            "every good picture has its GLB, once": set(rough) == good,
            "every corrupt picture has its line": refused == corrupt and len(records) == options.pictures,
        }
        for folder in sorted((base / "in").iterdir())[: options.again]:
            shutil.copytree(folder, base / "again" / folder.name)
        parts = tuple(f"{folder.name}/" for folder in (base / "again").iterdir())
        part = {name: digest for name, digest in rough.items() if name.startswith(parts)}
        for backend in (["serial"], ["dask", "--workers", "2"]):
            output = base / backend[0]
            subprocess.run(command(base / "again", output, "--backend", *backend), cwd=ROOT, check=True)
            checks[f"{len(part)} of them are those of backend {backend[0]} byte for byte"] = digests(output) == part
    print(
        f"| {options.pictures} pictures, {len(corrupt)} of them corrupt, a worker killed, two interruptions | holds |"
    )
    print("|---|---|")
    for what, holds in checks.items():
        print(f"| {what} | {'yes' if holds else 'NO'} |")
    return 0 if all(checks.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
