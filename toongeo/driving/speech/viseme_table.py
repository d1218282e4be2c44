"""Visemes, their names elsewhere, and how they hold their own: ``data_templates/visemes.csv``."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from toongeo.arrays import Floats
from toongeo.model import data_path
from toongeo.model.expression_schemes import EXPRESSIONS, PRESETS

__all__ = ["AZURE", "RHUBARB", "VISEMES", "VisemeEntry", "oculus_viseme"]

_LETTERS = {"i": "ih", "o": "oh", "u": "ou"}  # as avatars of Ready Player Me and TalkingHead call three of them


@dataclass(frozen=True)
class VisemeEntry:
    """How a viseme looks, and how it holds its own.

    Attributes
    ----------
    weights : (54,) float64
        Of our expressions.
    strength : float
    before, after : float, s
        In which its dominance falls to 1/e.
    """

    weights: Floats
    strength: float
    before: float
    after: float


def _rows() -> list[dict[str, str]]:
    with open(data_path("data_templates/visemes.csv"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _weights(name: str) -> Floats:
    shape = PRESETS[f"viseme_{name}"]
    return np.array([shape.get(expression, 0.0) for expression in EXPRESSIONS])


_ROWS = _rows()
VISEMES: Mapping[str, VisemeEntry] = MappingProxyType(
    {
        row["viseme"]: VisemeEntry(
            _weights(row["viseme"]),
            float(row["strength"]),
            float(row["before"]) / 1000,
            float(row["after"]) / 1000,
        )
        for row in _ROWS
    }
)
RHUBARB: Mapping[str, str] = MappingProxyType({letter: row["viseme"] for row in _ROWS for letter in row["rhubarb"]})
AZURE: Mapping[int, str] = MappingProxyType(
    {int(number): row["viseme"] for row in _ROWS for number in row["azure"].split()}
)
_ANY_CASE = {name.lower(): name for name in VISEMES} | _LETTERS


def oculus_viseme(name: str) -> str:
    """Our name of a viseme: with or without ``viseme_``, in any case, ``I O U`` for ``ih oh ou``.

    Raises
    ------
    ValueError
        If there is none of this name.

    Examples
    --------
    >>> oculus_viseme("viseme_I"), oculus_viseme("pp")
    ('ih', 'PP')
    """
    plain = name.removeprefix("viseme_").lower()
    if plain not in _ANY_CASE:
        raise ValueError(f"expected visemes {' '.join(VISEMES)}, got {name!r}")
    return _ANY_CASE[plain]
