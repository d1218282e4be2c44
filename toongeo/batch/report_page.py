"""A page about a batch: what failed and why, and how the others look."""

from __future__ import annotations

import html
from collections import Counter
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import quote

from toongeo.io import atomic_write

__all__ = ["REPORT", "write_report"]

REPORT = "report.html"
_MOST = 2000  # pictures of each kind that a page shows; browsers get slow beyond
_POLICY = "default-src 'none'; img-src 'self'; style-src 'unsafe-inline'"
_STYLE = """body{font:14px/1.4 sans-serif;margin:2em;color:#222}table{border-collapse:collapse}
td,th{padding:3px 10px;text-align:left;vertical-align:top;border-bottom:1px solid #ddd}
figure{display:inline-block;margin:6px;width:256px;vertical-align:top}figcaption{font-size:12px;overflow-wrap:anywhere}
.bad{color:#a00}"""


def write_report(output: Path, records: Iterable[dict[str, Any]]) -> None:
    """Write ``report.html`` beside the thumbnails, which it shows; it runs no script and loads nothing else.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    records = sorted(records, key=lambda record: str(record["picture"]))
    done = [record for record in records if record["status"] == "done"]
    failed = [record for record in records if record["status"] != "done"]
    counts = ", ".join(f"{count} {status}" for status, count in Counter(r["status"] for r in records).most_common())
    page = [
        "<!doctype html><meta charset=utf-8><title>Batch</title>",
        f'<meta http-equiv="Content-Security-Policy" content="{html.escape(_POLICY)}"><style>{_STYLE}</style>',
        f"<h1>{len(records)} pictures</h1><p>{html.escape(counts)}{_rate(done)}</p>",
        _failures(failed),
        "<h2>Done</h2>",
        *map(_figure, done[:_MOST]),
        _more(len(done)),
    ]
    atomic_write({output / REPORT: "\n".join(page).encode("utf-8", "replace")})


def _rate(done: list[dict[str, Any]]) -> str:
    seconds = sorted(record["seconds"]["total"] for record in done)
    return f"; {seconds[len(seconds) // 2]:.1f} s a picture (median), at most {seconds[-1]:.1f} s" if seconds else ""


def _failures(failed: list[dict[str, Any]]) -> str:
    if not failed:
        return ""
    rows = "\n".join(
        f"<tr><td>{_text(record['picture'])}<td class=bad>{_text(record['status'])}<td>{_text(record.get('error'))}"
        for record in failed[:_MOST]
    )
    return f"<h2>Failed</h2><table><tr><th>picture<th>status<th>why\n{rows}</table>{_more(len(failed))}"


def _figure(record: dict[str, Any]) -> str:
    metrics = record.get("metrics", {})
    aligned = [value for value in metrics.get("aligned", {}).values() if value is not None]
    error = f"error {100 * sum(aligned) / len(aligned):.2f} %, " if aligned else ""
    warnings = "".join(f"<br><span class=bad>{_text(warning)}</span>" for warning in record.get("warnings", ())[:3])
    picture = quote(str(record.get("thumbnail", "")).encode("utf-8", "surrogateescape"))
    return (
        f'<figure><img loading=lazy width=256 height=128 alt="" src="{picture}"><figcaption>'
        f"{_text(PurePosixPath(record['picture']))}<br>{error}{record['seconds']['total']:.1f} s{warnings}"
        "</figcaption></figure>"
    )


def _text(value: object) -> str:
    return html.escape(str(value))


def _more(count: int) -> str:
    return f"<p>and {count - _MOST} more, in the manifest</p>" if count > _MOST else ""
