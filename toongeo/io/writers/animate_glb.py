"""An animation added to any GLB."""

import copy
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from toongeo.io.atomic_write import atomic_write
from toongeo.io.gltf.glb_builder import GlbBuilder
from toongeo.io.readers.read_glb import read_glb

__all__ = ["animate_glb", "head_bone", "morph_targets"]

_HEADS = ("head", "neck", "j_bip_c_head", "cc_base_head", "mixamorig:head", "bip01 head")  # bones that carry a face


def animate_glb(
    path: str | os.PathLike[str],
    output: str | os.PathLike[str],
    times: NDArray[np.floating],
    weights: Mapping[str, NDArray[np.floating]],
    *,
    turns: NDArray[np.floating] | None = None,
    name: str = "take",
) -> None:
    """Write a copy of a GLB of any program whose first animation moves its morph targets; the rest stays as it is.

    Parameters
    ----------
    path
        A GLB whose morph targets have names (``extras.targetNames`` of its meshes, as Blender and we write them).
    output
        File to write, complete or not there.
    times : (f,) s
        Increasing, the first >= 0.
    weights : target -> (f,)
        Of some of its targets, in all meshes that have them; the others are 0.
    turns : (f, 4), optional
        Unit quaternions x, y, z, w by which its head turns in the world, whose axes are those of glTF: see `head_bone`.
    name : str
        Of the animation.

    Raises
    ------
    OSError
        If a file cannot be read or written.
    ValueError
        If it is no GLB, no mesh has a target of these names, it has no bone to turn, or times, weights and turns do not
        fit.
    """
    document = read_glb(path).json
    names = morph_targets(document)
    keys = np.asarray(times, np.float32)
    if keys.ndim != 1 or not len(keys) or not (np.diff(keys) > 0).all() or not keys[0] >= 0:
        raise ValueError("times: expected increasing seconds, the first >= 0")
    for target, column in weights.items():
        if np.shape(column) != keys.shape or not np.isfinite(column).all():
            raise ValueError(f"weights: expected ({len(keys)},) finite numbers for {target!r}, got {np.shape(column)}")
    builder = GlbBuilder.extending(copy.deepcopy(document), Path(path).read_bytes())
    builder.json.get("extras", {}).pop("toongeo", None)  # it is no longer the file of which that is the checksum
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    time = builder.accessor(keys, bounds=True)
    for number, node in enumerate(document.get("nodes", [])):
        targets = names.get(node.get("mesh", -1), ())
        if not set(targets) & set(weights):
            continue
        still = np.zeros(len(keys))
        values = np.column_stack([weights.get(target, still) for target in targets]).astype(np.float32)
        samplers.append({"input": time, "output": builder.accessor(values.ravel()), "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": number, "path": "weights"}})
    if turns is not None:
        bone = head_bone(document)
        if bone is None or np.shape(turns) != (len(keys), 4) or not np.isfinite(turns).all():
            raise ValueError(
                f"turns: expected ({len(keys)}, 4) and a bone named head, got {np.shape(turns)}, node {bone}"
            )
        values = _local_turns(document["nodes"], bone, turns).astype(np.float32)
        samplers.append({"input": time, "output": builder.accessor(values), "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": bone, "path": "rotation"}})
    if not channels:
        raise ValueError(f"weights: expected targets of {path}, got {', '.join(list(weights)[:5])}")
    others = builder.json.get("animations", [])
    builder.json["animations"] = [{"name": name, "channels": channels, "samplers": samplers}, *others]
    atomic_write({output: builder.encode()})


def head_bone(document: dict[str, Any]) -> int | None:
    """The node of a glTF document that turns its head, by its name; None if there is none.

    A node with a mesh is none: the rest of the face would stay. Nodes with a matrix cannot be animated.
    """
    names = {
        str(node.get("name", "")).lower(): number
        for number, node in reversed(list(enumerate(document.get("nodes", []))))
        if "mesh" not in node and "matrix" not in node
    }
    return next((names[name] for name in _HEADS if name in names), None)


def _local_turns(nodes: list[dict[str, Any]], bone: int, turns: NDArray[np.floating]) -> NDArray[np.float64]:
    """Rotations (f, 4) of a bone in the frame of its parent that turn it in the world by ``turns`` from where it is."""
    above = {child: number for number, node in enumerate(nodes) for child in node.get("children", [])}
    world, number = Rotation.identity(), above.get(bone)
    while number is not None:
        world = Rotation.from_quat(nodes[number].get("rotation", [0, 0, 0, 1])) * world
        number = above.get(number)
    rest = Rotation.from_quat(nodes[bone].get("rotation", [0, 0, 0, 1]))
    local = (world.inv() * Rotation.from_quat(turns) * world * rest).as_quat()
    signs = np.cumprod(np.r_[1.0, np.where((local[1:] * local[:-1]).sum(axis=1) < 0, -1.0, 1.0)])
    return np.asarray(local * signs[:, None])


def morph_targets(document: dict[str, Any]) -> dict[int, tuple[str, ...]]:
    """Names of the morph targets of each mesh of a glTF document that has some."""
    names = {}
    for number, mesh in enumerate(document.get("meshes", [])):
        extras = mesh.get("extras")
        found = extras.get("targetNames") if isinstance(extras, dict) else None
        count = len(mesh["primitives"][0].get("targets", ())) if mesh.get("primitives") else 0
        if isinstance(found, list) and len(found) == count > 0 and all(isinstance(name, str) for name in found):
            names[number] = tuple(found)
    return names
