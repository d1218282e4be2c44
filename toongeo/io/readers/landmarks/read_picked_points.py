"""Points that were picked on a mesh in MeshLab: ``.pp``."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.readers.landmarks.number_words import number
from toongeo.io.readers.landmarks.xml_elements import xml_elements

__all__ = ["read_picked_points"]


def read_picked_points(path: Path) -> NDArray[np.float64]:
    """Points (k, 3): in the order of their names if these are the numbers from 0 or from 1, else of the file.

    Points that are not active are missing.

    Raises
    ------
    ValueError, OSError
        If it is no such XML, or a coordinate is no number.
    """
    names: list[str] = []
    points: list[list[float]] = []

    def visit(element: str, attributes: dict[str, str], line: int) -> None:
        if element != "point":
            return
        place = [number(attributes.get(axis, "").replace(",", ".")) for axis in "xyz"]
        if None in place:
            raise ValueError(f"path: expected numbers as x, y and z of a point in line {line} of {path}")
        names.append(attributes.get("name", ""))
        points.append(
            [float(x) for x in place if x is not None] if attributes.get("active", "1") != "0" else [np.nan] * 3
        )

    xml_elements(path, visit)
    if not points:
        raise ValueError(f"path: expected <point> of MeshLab's picked points, but not in {path}")
    found = np.array(points)
    for start in (0, 1):
        wanted = [str(k + start) for k in range(len(names))]
        if sorted(names) == sorted(wanted):
            return found[[names.index(name) for name in wanted]]
    return found
