"""What each named expression moves, from tables in ``data_templates/``.

``FEATURES`` maps a feature to its size (pairs of landmarks) and the landmarks that travel with it, ``FEATURE_OF`` an
expression to its feature, ``REMOVED`` are the expressions that are taken out of a face to make it neutral, and
``SIGNS`` groups of them that tell that a face is not.

>>> FEATURE_OF["mouthPucker"], FEATURES["mouth"].size, SIGNS["smile"]
('mouth', ((48, 54),), ('mouthSmileLeft', 'mouthSmileRight'))
"""

import csv
from types import MappingProxyType
from typing import NamedTuple

from toongeo.model.data_path import data_path

__all__ = ["FEATURES", "FEATURE_OF", "REMOVED", "SIGNS", "Feature"]


class Feature(NamedTuple):
    """Pairs of iBUG-68 points whose mean distance is a feature's size, and the points whose motion counts."""

    size: tuple[tuple[int, int], ...]
    travel: tuple[int, ...]


def _rows(table: str) -> list[dict[str, str]]:
    with open(data_path(f"data_templates/{table}"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _feature(row: dict[str, str]) -> Feature:
    pairs = (pair.split("-") for pair in row["size"].split())
    return Feature(tuple((int(a), int(b)) for a, b in pairs), tuple(map(int, row["travel"].split())))


_ROWS = _rows("expression_features.csv")
_SIGNS = dict.fromkeys(row["sign"] for row in _ROWS if row["sign"])

FEATURES = MappingProxyType({row["feature"]: _feature(row) for row in _rows("features.csv")})
FEATURE_OF = MappingProxyType({row["name"]: row["feature"] for row in _ROWS if row["feature"]})
REMOVED = frozenset(row["name"] for row in _ROWS if row["removed"])
SIGNS = MappingProxyType({sign: tuple(row["name"] for row in _ROWS if row["sign"] == sign) for sign in _SIGNS})
