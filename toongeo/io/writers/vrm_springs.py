"""Meshes that swing, in VRM: bones of chains, what follows them, and the extension ``VRMC_springBone``."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io.scene import METRES, Scene, SceneMesh
from toongeo.io.split_seams import split_seams

__all__ = ["followed_bones", "spring_entry", "spring_rows"]

# Of three-vrm's and UniVRM's ranges (stiffness 0..4, drag 0..1) the calm ends: hair follows within half a second and
# swings over once. Bones point down already, and need no pull.
_GENTLE = {"hitRadius": 0.0, "stiffness": 2.0, "gravityPower": 0.0, "gravityDir": [0.0, -1.0, 0.0], "dragForce": 0.5}
_MOST = 4  # bones that a vertex of glTF follows


def spring_rows(scene: Scene, parent: str) -> list[tuple[str, str, str, NDArray[np.floating]]]:
    """Name, VRM's name (none), parent and place (3,), mm, of each joint; parents come first."""
    rows = []
    for mesh in scene.meshes:
        for chain, joints in enumerate(mesh.springs.joints if mesh.springs is not None else ()):
            above = parent
            for k, place in enumerate(joints):
                name = _name(mesh, chain, k)
                rows.append((name, "", above, place))
                above = name
    return rows


def followed_bones(mesh: SceneMesh, order: Mapping[str, int], still: str) -> tuple[NDArray, NDArray]:
    """Bones and shares (p, 4) uint8 that each point of a mesh in the file follows; shares add up to 255.

    ``order`` gives the number of each bone by its name, ``still`` names the one that the rest follows.
    """
    vertex = split_seams(mesh.faces, mesh.faces if mesh.uv_faces is None else mesh.uv_faces)[0]
    bones, shares = np.zeros((len(vertex), _MOST), np.uint8), np.zeros((len(vertex), _MOST), np.uint8)
    bones[:, 0], shares[:, 0] = order[still], 255
    if mesh.springs is None:
        return bones, shares
    weights = mesh.springs.weights[vertex]
    chains, links = weights.shape[1:]
    names = [still, *(_name(mesh, chain, k) for chain in range(chains) for k in range(links))]
    weights = weights.reshape(len(vertex), -1)
    whole = np.column_stack([1 - weights.sum(1), weights])
    first = np.argsort(-whole, 1, kind="stable")[:, :_MOST]
    kept = np.take_along_axis(whole, first, 1)
    numbers = np.array([order[name] for name in names])
    count = first.shape[1]
    shares[:, :count] = np.floor(255 * kept / kept.sum(1, keepdims=True))
    shares[:, 0] += (255 - shares.sum(1, dtype=np.int64)).astype(np.uint8)
    bones[:, :count] = np.where(shares[:, :count] > 0, numbers[first], 0)  # a bone without a share is to be 0
    return bones, shares


def spring_entry(
    scene: Scene, nodes: Mapping[str, int], parent: str, place: NDArray[np.floating]
) -> dict[str, Any] | None:
    """The extension; None if nothing swings. ``nodes`` gives the node of each bone by its name.

    ``parent`` is the bone at ``place`` (3,), mm, that the chains hang from and that carries what they stay out of.
    """
    springs: list[dict[str, Any]] = []
    colliders: list[dict[str, Any]] = []
    groups: list[dict[str, Any]] = []
    for mesh in scene.meshes:
        if mesh.springs is None:
            continue
        found = [{"node": nodes[parent], "shape": {"capsule": _capsule(row, place)}} for row in mesh.springs.capsules]
        for chain, joints in enumerate(mesh.springs.joints):
            entry = {
                "name": f"{mesh.name}_{chain}",
                "joints": [{"node": nodes[_name(mesh, chain, k)], **_GENTLE} for k in range(len(joints))],
            }
            springs.append(entry | ({"colliderGroups": [len(groups)]} if found else {}))
        if found:
            groups.append({"name": mesh.name, "colliders": [len(colliders) + k for k in range(len(found))]})
            colliders += found
    if not springs:
        return None
    around = {"colliders": colliders, "colliderGroups": groups} if groups else {}
    return {"specVersion": "1.0", **around, "springs": springs}


def _capsule(row: NDArray[np.floating], place: NDArray[np.floating]) -> dict[str, Any]:
    start, end, radius = row[:3], row[3:6], float(row[6])
    return {
        "offset": ((start - place) * METRES).tolist(),
        "radius": radius * METRES,
        "tail": ((end - place) * METRES).tolist(),
    }


def _name(mesh: SceneMesh, chain: int, joint: int) -> str:
    return f"{mesh.name}_{chain}_{joint}"
