"""Take RESULTS.md apart into texts and records, of which `toongeo bench all` puts it together again.

usage: python benchmarks/split_results.py

Run it after RESULTS.md itself was edited. Texts go to benchmarks/sections, numbered in their order; tables to
benchmarks/records. A table that is as it was keeps what is known of its run; of any other, date and commit are those by
which its lines came in, as git tells.
"""

import re
import subprocess
from datetime import UTC, datetime
from pathlib import Path

from toongeo.app.bench.results.bench_all import assemble
from toongeo.app.bench.results.record import Record, read_records, write_record
from toongeo.app.bench.results.split_results import split_results

FOLDER = Path(__file__).parent


def born(first: int, last: int) -> tuple[str, str]:
    """Date and commit of the newest of these lines of RESULTS.md."""
    told = subprocess.run(
        ["git", "blame", "--porcelain", f"-L{first},{last}", "RESULTS.md"],
        cwd=FOLDER, capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    times: dict[str, int] = {}
    for line in told.splitlines():
        if match := re.match(r"([0-9a-f]{40}) \d", line):
            commit = match[1]
        elif line.startswith("author-time "):
            times[commit] = int(line.split()[1])
    newest = max(times, key=times.__getitem__)
    return datetime.fromtimestamp(times[newest], UTC).date().isoformat(), "" if set(newest) == {"0"} else newest[:7]


def main() -> None:
    sections, tables = split_results((FOLDER / "RESULTS.md").read_text(encoding="utf-8"))
    for name in ("sections", "records"):
        (FOLDER / name).mkdir(exist_ok=True)
    old = read_records(FOLDER / "records")
    for path in (*(FOLDER / "sections").glob("*.md"), *(FOLDER / "records").glob("*.md")):
        path.unlink()
    for number, (slug, text) in enumerate(sections.items()):
        (FOLDER / "sections" / f"{number:02d}-{slug}.md").write_text(f"{text}\n", encoding="utf-8")
    for table in tables:
        record = old.get(table.name)
        if record is None or record.body != table.body:
            date, commit = born(table.line, table.line + table.body.count("\n"))
            record = Record(table.name, table.command, date, commit, "", "", table.body)
        write_record(FOLDER / "records", record)
    assemble(FOLDER)
    print(f"{len(sections)} texts, {len(tables)} records")


if __name__ == "__main__":
    main()
