"""What the editor's page knows from the beginning."""

import csv
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

from toongeo.app.editor.picture_list import FORMATS
from toongeo.app.editor.place_landmarks import FEWEST_CLICKS
from toongeo.model import default_model
from toongeo.model.ibug68 import MIRROR, NAMES, OUTER_EYES, PARTS
from toongeo.pipeline.align.symmetric_field import FieldPrior

__all__ = ["editor_settings"]

# How far neighbours follow a point that is dragged softly, in outer-eye distances: its part comes along, others hardly.
# Half as far as in the flow of the alignment, which also may move the whole face.
_REACH = 0.25


def editor_settings() -> dict[str, Any]:
    """Names, parts, mirror, lines and order of clicks of the iBUG-68 points, and the prior of soft drags."""
    prior = FieldPrior(reach=_REACH)
    face = default_model().mean[default_model().landmarks]
    unit = face[OUTER_EYES[1], 0] - face[OUTER_EYES[0], 0]
    lines = [
        {"name": row["name"], "first": int(row["first"]), "last": int(row["last"]), "closed": row["closed"] == "1"}
        for row in _rows("contours.csv")
    ]
    return {
        "names": list(NAMES),
        "parts": {part: points.tolist() for part, points in PARTS.items()},
        "mirror": MIRROR.tolist(),
        "eyes": list(OUTER_EYES),
        "face": [[float(x / unit), float(-y / unit)] for x, y, _ in face],
        "lines": lines,
        "clicks": [{"point": int(row["point"]), "what": row["what"]} for row in _rows("clicks.csv")],
        "fewestClicks": FEWEST_CLICKS,
        "prior": {"reach": prior.reach, "growth": prior.growth, "noise": prior.noise},
        "formats": list(FORMATS[:3]),
    }


def _rows(table: str) -> Iterator[dict[str, str]]:
    text = files("toongeo.app.editor").joinpath(table).read_text(encoding="utf-8")
    return csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
