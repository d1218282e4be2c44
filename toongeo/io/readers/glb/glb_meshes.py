"""The meshes that a GLB of any program shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from toongeo.arrays import Floats, Integers
from toongeo.io.readers.glb.base_colour import base_colour
from toongeo.io.readers.glb.node_places import node_places
from toongeo.io.readers.read_glb import GlbDocument
from toongeo.io.scene import SceneMesh

__all__ = ["glb_meshes"]

_TRIANGLES, _STRIP, _FAN = 4, 5, 6  # modes of a primitive (3.7.2.1); the others are points and lines
_MOST = 2 * 10**7  # vertices and triangles of all that is shown: nodes may show a mesh ever again


def glb_meshes(document: GlbDocument) -> list[SceneMesh]:
    """Every primitive with triangles, as often as nodes show it, where they put it.

    In the order of the file's meshes, their primitives, and the names of the nodes. Normalized integers are fractions
    (3.6.2.2), sparse accessors are filled in, texture coordinates are those that the base colour uses, moved as
    KHR_texture_transform says. A mirror turns triangles over.

    Raises
    ------
    ValueError, LookupError, TypeError
        If the file is not what the specification says.
    """
    places = node_places(document.json)
    shown: dict[int, list[tuple[str, int]]] = {}
    for k in places:
        node = document.json["nodes"][k]
        shown.setdefault(node.get("mesh", -1), []).append((_name(node, str(k)), k))
    found: dict[str, SceneMesh] = {}
    size = 0
    for index, mesh in enumerate(document.json.get("meshes", [])):
        nodes = sorted(shown.get(index, []))
        for primitive in mesh["primitives"]:
            faces = _triangles(document, primitive)
            for label, k in nodes if len(faces) else ():
                size += len(faces) + len(document.accessors[primitive["attributes"]["POSITION"]])
                if size > _MOST:
                    raise ValueError(f"it shows more than {_MOST} vertices and triangles")
                name = _unused(_name(mesh, "mesh") + (f".{label}" if len(nodes) > 1 else ""), found)
                found[name] = _mesh(document, primitive, faces, places[k], name)
    return list(found.values())


def _unused(name: str, used: Mapping[str, SceneMesh]) -> str:
    """The name, or a number behind it."""
    return next(new for k in range(len(used) + 1) if (new := f"{name}_{k}" if k else name) not in used)


def _name(entry: dict[str, Any], default: str) -> str:
    name = entry.get("name", default)
    if not isinstance(name, str):
        raise ValueError(f"a name is {name!r}")
    return name or default


def _triangles(document: GlbDocument, primitive: dict[str, Any]) -> Integers:
    """(m, 3), those of strips and fans too (3.7.2.1); none of points and lines."""
    mode = primitive.get("mode", _TRIANGLES)
    if mode not in (_TRIANGLES, _STRIP, _FAN):
        return np.empty((0, 3), np.int64)
    if "indices" in primitive:
        order = document.accessors[primitive["indices"]].astype(np.int64)
    else:
        order = np.arange(len(document.accessors[primitive["attributes"]["POSITION"]]))
    if mode == _TRIANGLES:
        return order.reshape(-1, 3)
    first = np.arange(len(order) - 2)
    if mode == _FAN:
        corners = np.stack([first + 1, first + 2, 0 * first], axis=1)
    else:
        odd = first % 2
        corners = np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)
    faces = order[corners]
    return faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]  # strips are joined by triangles without area


def _mesh(document: GlbDocument, primitive: dict[str, Any], faces: Integers, place: Floats, name: str) -> SceneMesh:
    attributes = primitive["attributes"]
    look = base_colour(document, primitive)
    uv = attributes.get(f"TEXCOORD_{look.texcoord}")
    matrix = place[:3, :3]
    if np.linalg.det(matrix) == 0:
        raise ValueError(f"mesh {name!r} is scaled to nothing")
    vertices = _numbers(document, attributes["POSITION"]) @ matrix.T + place[:3, 3]
    return SceneMesh(
        name=name,
        vertices=vertices,
        faces=faces if np.linalg.det(matrix) > 0 else faces[:, ::-1],
        uv=None if uv is None else _moved(_numbers(document, uv), look.transform),
        normals=_normals(document, attributes, matrix),
        texture=None if uv is None else look.picture,
        color=look.color,
    )


def _moved(uv: Floats, transform: Floats) -> Floats:
    """Texture coordinates of the file, v up."""
    return np.asarray((uv @ transform[:2, :2].T + transform[:2, 2]) * [1, -1] + [0, 1])


def _normals(document: GlbDocument, attributes: dict[str, int], matrix: Floats) -> Floats | None:
    """Those of the file, which know nothing of its seams; None if one has no direction."""
    if "NORMAL" not in attributes:
        return None
    normals = _numbers(document, attributes["NORMAL"]) @ np.linalg.inv(matrix)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / length if (length > 0).all() and np.isfinite(length).all() else None


def _numbers(document: GlbDocument, index: int) -> Floats:
    """An accessor; integers that stand for fractions of 1 as these fractions (3.6.2.2)."""
    array = document.accessors[index]
    numbers = array.astype(np.float64)
    if document.json["accessors"][index].get("normalized", False) and array.dtype.kind in "iu":
        return np.maximum(numbers / np.iinfo(array.dtype).max, -1.0)
    return numbers
