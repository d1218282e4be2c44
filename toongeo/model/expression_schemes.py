"""Names of expressions in several systems, from tables in ``data_templates/``.

``EXPRESSIONS`` are our own 54 names: the 46 of the template, then the eight ``eyeLook*`` directions of the gaze.
``SCHEMES`` maps a scheme to its names in its own order, and each name to its weights by our names; an empty mapping is
a name that moves nothing (``_neutral``, ``HeadYaw``). ``PRESETS`` holds whole expressions and visemes the same way.

>>> len(EXPRESSIONS), {scheme: len(names) for scheme, names in SCHEMES.items() if scheme != "facs"}
(54, {'arkit': 52, 'mediapipe': 52, 'live_link': 61, 'oculus': 15, 'vrm': 18})
>>> dict(SCHEMES["arkit"]["browInnerUp"])
{'browInnerUpLeft': 1.0, 'browInnerUpRight': 1.0}
"""

import csv
from collections.abc import Mapping
from types import MappingProxyType

from toongeo.model.data_path import data_path

__all__ = ["EXPRESSIONS", "GAZE", "PRESETS", "SCHEMES"]

_Weights = Mapping[str, float]
GAZE = tuple(f"eyeLook{direction}{side}" for side in ("Left", "Right") for direction in ("In", "Out", "Up", "Down"))


def _rows(table: str) -> list[dict[str, str]]:
    with open(data_path(f"data_templates/{table}"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _parts(weights: str) -> dict[str, float]:
    """``"a b:0.5"`` as ``{"a": 1.0, "b": 0.5}``."""
    pairs = (part.partition(":") for part in weights.split())
    return {name: float(weight or 1) for name, _, weight in pairs}


def _resolved(name: str, weight: float) -> dict[str, float]:
    """A name with all that it refers to replaced by our own names; what comes up twice adds up."""
    if name in EXPRESSIONS:
        return {name: weight}
    total: dict[str, float] = {}
    for part, share in _DEFINED[name].items():
        for own, amount in _resolved(part, round(weight * share, 6)).items():
            total[own] = round(total.get(own, 0.0) + amount, 6)
    return total


EXPRESSIONS = (*(row["name"] for row in _rows("expressions.csv")), *GAZE)
_ROWS, _PRESETS = _rows("expression_schemes.csv"), _rows("presets.csv")
# The first definition of a name counts; later schemes that have it too refer to it.
_DEFINED = {row["name"]: _parts(row["weights"]) for row in reversed(_PRESETS + _ROWS)}


def _frozen(rows: list[dict[str, str]]) -> Mapping[str, _Weights]:
    return MappingProxyType({row["name"]: MappingProxyType(_resolved(row["name"], 1.0)) for row in rows})


SCHEMES: Mapping[str, Mapping[str, _Weights]] = MappingProxyType(
    {
        scheme: _frozen([row for row in _ROWS if row["scheme"] == scheme])
        for scheme in dict.fromkeys(row["scheme"] for row in _ROWS)
    }
)
PRESETS = _frozen(_PRESETS)
