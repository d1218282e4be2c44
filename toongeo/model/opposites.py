"""Expressions that exclude each other, from the table ``data_templates/opposites.csv``."""

from __future__ import annotations

import csv

import numpy as np
from numpy.typing import NDArray

from toongeo.model.data_path import data_path
from toongeo.model.morphable_model import MorphableModel

__all__ = ["OPPOSITES", "opposite_expressions"]


def _pairs() -> tuple[tuple[str, str], ...]:
    with open(data_path("data_templates/opposites.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return tuple((row["name"], row["opposite"]) for row in rows)


OPPOSITES = _pairs()


def opposite_expressions(model: MorphableModel) -> NDArray[np.int64]:
    """Indices (p, 2) of expressions of a model that exclude each other.

    Examples
    --------
    >>> from toongeo.model import default_model
    >>> model = default_model()
    >>> [model.expression_names[k] for k in opposite_expressions(model)[0]]
    ['jawLeft', 'jawRight']
    """
    known = set(model.expression_names)
    pairs = [[model.expression_index(name) for name in pair] for pair in OPPOSITES if known.issuperset(pair)]
    return np.array(pairs, np.int64).reshape(-1, 2)
