"""What a benchmark printed, and when."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

__all__ = ["Record", "read_records", "write_record"]


@dataclass(frozen=True)
class Record:
    """One table of the results.

    Attributes
    ----------
    name : str
        Of its file, and of its place in a text.
    command : str
        That printed it; empty if it was put together by hand.
    date : str
        YYYY-MM-DD, of the run.
    commit : str
        Short hash of the code that ran, or of that by which the table came in.
    versions : str
        Of Python and of packages that matter; empty if they were not written down.
    machine : str
        Cores, and how busy they were; empty likewise.
    body : str
        The table, or all that was printed; without empty lines at its ends.
    """

    name: str
    command: str
    date: str
    commit: str
    versions: str
    machine: str
    body: str

    def shown(self) -> str:
        """The table in the file of results, with its origin beneath."""
        origin = ", ".join(
            part for part in (self.date, self.commit and f"at {self.commit}", self.versions, self.machine) if part
        )
        return f"<!-- record: {self.name} -->\n{self.body}\n\n<sub>Recorded {origin}.</sub>"


_HEAD = tuple(field.name for field in fields(Record) if field.name not in ("name", "body"))


def read_records(folder: Path) -> dict[str, Record]:
    """The records of a folder by name.

    Raises
    ------
    ValueError
        If one has no head.
    """
    records = {}
    for path in sorted(folder.glob("*.md")):
        head, _, body = path.read_text(encoding="utf-8").partition("\n\n")
        entries = {name: value.strip() for name, _, value in (line.partition(":") for line in head.splitlines())}
        if set(entries) != set(_HEAD):
            raise ValueError(f"{path}: expected the lines {', '.join(_HEAD)} first, got {', '.join(entries)}")
        records[path.stem] = Record(path.stem, **entries, body=body.strip("\n"))
    return records


def write_record(folder: Path, record: Record) -> None:
    """Write its file, or replace it."""
    head = "".join(f"{name}: {getattr(record, name)}".rstrip() + "\n" for name in _HEAD)
    (folder / f"{record.name}.md").write_text(f"{head}\n{record.body}\n", encoding="utf-8")
