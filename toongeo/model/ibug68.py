"""The iBUG-68 landmark scheme: names, parts, mirror permutation and rims, from tables in ``data_templates/``.

``PARTS`` maps a part to its points (indices in order), ``INNER`` are the 51 points that are not on the
jaw, ``MIRROR`` is the permutation with which a mirrored picture's points read ``mirrored[MIRROR]``, and
``OUTER_EYES`` are the two outer eye corners, whose distance is the usual unit of landmark errors. ``LID_RIMS`` and
``LIP_RIMS`` map the name of a rim to its points from corner to corner.

>>> PARTS["jaw"][[0, -1]], len(INNER), OUTER_EYES
(array([ 0, 16]), 51, (36, 45))
>>> bool((MIRROR[MIRROR] == range(68)).all())
True
"""

import csv
from types import MappingProxyType

import numpy as np

from toongeo.model.data_path import data_path

__all__ = ["INNER", "LID_RIMS", "LIP_RIMS", "MIRROR", "NAMES", "OUTER_EYES", "PARTS"]


def _rows(table: str) -> list[dict[str, str]]:
    with open(data_path(f"data_templates/{table}"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _rims(kind: str) -> MappingProxyType[str, tuple[int, ...]]:
    rows = [row for row in _rows("rims.csv") if row["kind"] == kind]
    return MappingProxyType({row["name"]: tuple(map(int, row["points"].split())) for row in rows})


def _frozen(indices: list[int]) -> np.ndarray:
    array = np.array(indices, np.int64)
    array.setflags(write=False)
    return array


_ROWS = _rows("ibug68.csv")
_PART = [row["part"] for row in _ROWS]

NAMES = tuple(row["name"] for row in _ROWS)
PARTS = MappingProxyType(
    {part: _frozen([k for k, p in enumerate(_PART) if p == part]) for part in dict.fromkeys(_PART)}
)
INNER = _frozen([k for k, part in enumerate(_PART) if part != "jaw"])
MIRROR = _frozen([int(row["mirror"]) for row in _ROWS])
OUTER_EYES = (NAMES.index("eye_right_outer_corner"), NAMES.index("eye_left_outer_corner"))
LID_RIMS, LIP_RIMS = _rims("lid"), _rims("lip")
