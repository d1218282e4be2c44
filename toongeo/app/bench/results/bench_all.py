"""All benchmarks by one command."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from tqdm import tqdm

from toongeo.app.bench.results.assemble_results import assemble_results
from toongeo.app.bench.results.record import Record, read_records, write_record
from toongeo.app.bench.results.run_command import filled_command, origin, run_command
from toongeo.app.bench.results.update_records import update_records

__all__ = ["assemble", "bench_all", "bench_quick"]

_LEAST = 5.0  # s that a command gets at least: to begin with less is not worth it


def bench_all(folder: Path, only: Sequence[str] = (), data: Mapping[str, str] | None = None) -> list[str]:
    """Run the commands of all records, and write the file of results anew.

    Parameters
    ----------
    folder : Path
        ``benchmarks`` of a checkout.
    only : sequence of str
        Sections, or parts of their names, whose commands are run; all unless given.
    data : word -> path, optional
        For words in capitals that stand for data which does not travel with the project.

    Returns
    -------
    list of str
        Why commands could not run, one each. Their records stay, with their dates.
    """
    kept = folder / "records"
    troubles = []
    for command, records in tqdm(_commands(read_records(kept), only).items(), unit="command"):
        try:
            filled = filled_command(command, data or {})
        except ValueError as error:
            troubles.append(str(error))
            continue
        about = origin(folder.parent)
        ran = run_command(filled, folder.parent)
        if ran.failure:
            troubles.append(f"{command}: {ran.failure}")
            continue
        for record in update_records(records, ran.printed, about):
            write_record(kept, record)
    assemble(folder)
    return troubles


def bench_quick(folder: Path, seconds: float) -> None:
    """Run the commands of ``quick.txt`` in so many seconds, and print what they print; no record changes."""
    about, ends = origin(folder.parent), time.monotonic() + seconds
    print(", ".join(about.values()))
    for line in (folder / "quick.txt").read_text(encoding="utf-8").splitlines():
        left = ends - time.monotonic()
        if left < _LEAST:
            print(f"\n{line}: left out, the time is over")
            continue
        ran = run_command(line, folder.parent, left)
        print(f"\n{line} ({ran.seconds:.0f} s)\n\n{ran.failure or ran.printed}", flush=True)


def assemble(folder: Path) -> None:
    """Write ``RESULTS.md`` of a folder from its ``sections`` and ``records``."""
    sections = {path.stem: path.read_text(encoding="utf-8").strip("\n") for path in _texts(folder)}
    text = assemble_results(sections, read_records(folder / "records"))
    (folder / "RESULTS.md").write_text(text, encoding="utf-8")


def _texts(folder: Path) -> list[Path]:
    texts = sorted((folder / "sections").glob("*.md"))
    if not texts:
        raise FileNotFoundError(f"benchmarks: expected a checkout's folder with texts in sections/, got {folder}")
    return texts


def _commands(records: Mapping[str, Record], only: Sequence[str]) -> dict[str, list[Record]]:
    """The records of each command that was written down."""
    commands: dict[str, list[Record]] = {}
    for record in records.values():
        if record.command and (not only or any(part in record.name for part in only)):
            commands.setdefault(record.command, []).append(record)
    return commands
