"""Where the nodes of a glTF put what hangs on them."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from toongeo.arrays import Floats

__all__ = ["node_places"]


def node_places(document: dict[str, Any]) -> dict[int, Floats]:
    """Matrix (4, 4) to the world of every node of the scene that is shown.

    That is the one the file names, or else its first; without scenes every node counts (3.5 of the specification).

    Raises
    ------
    ValueError
        If a node comes twice: below itself, or below two others.
    """
    nodes, scenes = document.get("nodes", []), document.get("scenes", [])
    if scenes:
        roots = scenes[document.get("scene", 0)].get("nodes", [])
    else:
        below = {child for node in nodes for child in node.get("children", [])}
        roots = [k for k in range(len(nodes)) if k not in below]
    places: dict[int, Floats] = {}
    waiting = [(root, np.eye(4)) for root in roots]
    while waiting:
        k, above = waiting.pop()
        if k in places:
            raise ValueError(f"node {k} hangs below itself, or below two others")
        places[k] = above @ _local(nodes[k])
        waiting += [(child, places[k]) for child in nodes[k].get("children", [])]
    return places


def _local(node: dict[str, Any]) -> Floats:
    """The matrix of a node, or its translation, rotation and scale (3.5.3)."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    place = np.eye(4)
    turn = np.array(node.get("rotation", [0, 0, 0, 1]), np.float64)
    if turn.any():
        place[:3, :3] = Rotation.from_quat(turn).as_matrix()
    place[:3, :3] *= np.array(node.get("scale", [1, 1, 1]), np.float64)
    place[:3, 3] = node.get("translation", [0, 0, 0])
    return place
