"""The names of the weights that a driver gives: all that an avatar of the default model can show."""

import csv

from toongeo.model.data_path import data_path
from toongeo.pipeline.rig.gaze import GAZE_NAMES

__all__ = ["NAMES"]


def _expressions() -> tuple[str, ...]:
    with open(data_path("data_templates/expressions.csv"), encoding="utf-8", newline="") as file:
        return tuple(row["name"] for row in csv.DictReader(line for line in file if not line.startswith("#")))


NAMES = (*_expressions(), *GAZE_NAMES)
