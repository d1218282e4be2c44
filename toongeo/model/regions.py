"""Names of the regions of a head, ``REGIONS``, from the table ``data_templates/regions.csv``.

>>> "teeth_upper" in REGIONS
True
"""

import csv

from toongeo.model.data_path import data_path

__all__ = ["REGIONS"]


def _names() -> tuple[str, ...]:
    with open(data_path("data_templates/regions.csv"), encoding="utf-8", newline="") as file:
        return tuple(row["name"] for row in csv.DictReader(line for line in file if not line.startswith("#")))


REGIONS = _names()
