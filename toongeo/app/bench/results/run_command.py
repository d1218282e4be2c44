"""Benchmarks as commands."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from importlib.metadata import version
from pathlib import Path

__all__ = ["Ran", "filled_command", "origin", "run_command"]

_DATA = re.compile(r"(?<![\w/.-])([A-Z]{3,})(?![\w=])")  # a word in capitals stands for a folder or file of the reader
_PACKAGES = ("numpy", "scipy", "libigl", "opencv-contrib-python-headless")


@dataclass(frozen=True)
class Ran:
    """What came of a command: what it printed, why it failed (empty if it did not), and how long it took, s."""

    printed: str
    failure: str
    seconds: float


def filled_command(command: str, data: Mapping[str, str]) -> str:
    """The command with paths for the words in capitals.

    Raises
    ------
    ValueError
        If a word has none, or the command is only the outline of one.
    """
    if re.search(r"\.\.\.|\|| N\b", command):
        raise ValueError(f"{command}: several commands in one, to be run by hand")
    missing = sorted({word for word in _DATA.findall(command) if word not in data})
    if missing:
        raise ValueError(f"{command}: expected --data {missing[0]}=PATH: data that does not travel with the project")
    return _DATA.sub(lambda word: data[word[1]], command)


def run_command(command: str, root: Path, seconds: float | None = None) -> Ran:
    """Run a command in the checkout, on one thread of BLAS, with this Python.

    What it prints to the standard output is kept. It ends after so many seconds, if given.
    """
    environment = {
        **os.environ,
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]),
        "PYTHONPATH": os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")]),
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
    }
    started = time.monotonic()
    try:
        done = subprocess.run(
            ["bash", "-c", command],  # for braces and leading variables, as they are written in the texts
            cwd=root, env=environment, capture_output=True, text=True, timeout=seconds, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return Ran("", f"not done after {seconds:.0f} s", time.monotonic() - started)
    lines = done.stderr.strip().splitlines()
    failure = "" if done.returncode == 0 else (lines[-1] if lines else f"exit code {done.returncode}")
    return Ran(done.stdout.strip("\n"), failure, time.monotonic() - started)


def origin(root: Path) -> dict[str, str]:
    """Date, commit, versions and machine of a run that begins now."""
    revision = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True, check=False
    ).stdout.strip()
    packages = ", ".join(f"{name.split('-')[0]} {version(name)}" for name in _PACKAGES)
    busy = f", load {os.getloadavg()[0]:.0f}" if hasattr(os, "getloadavg") else ""
    return {
        "date": date.today().isoformat(),
        "commit": revision,
        "versions": f"Python {platform.python_version()}, {packages}",
        "machine": f"{os.cpu_count()} cores ({platform.machine()}){busy}",
    }
