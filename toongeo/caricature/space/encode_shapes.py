"""Shapes of one topology as deformations of a reference."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats, Singles
from toongeo.caricature.space.deformation_representation import rotation_and_stretch
from toongeo.geometry import validate_mesh, vertex_components
from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.operators.one_rings import OneRings, one_rings
from toongeo.geometry.rotations.rigid_rotation import rigid_rotation
from toongeo.geometry.validate_mesh import validate_vertices

__all__ = ["component_means", "encode_shapes"]


def encode_shapes(
    V: ArrayLike, F: ArrayLike, shapes: Sequence[ArrayLike] | NDArray, *, align: bool
) -> tuple[Floats, NDArray[np.int64], Singles, Singles, Singles, Floats, OneRings]:
    """Reference, triangles, rotations, stretches, bends, offsets and rings of `DeformationSpace.from_meshes`."""
    V, F = validate_mesh(V, F, names=("V_ref", "F"))
    if len(shapes) < 2:
        raise ValueError(f"shapes: expected at least 2, got {len(shapes)}")
    checked = [validate_vertices(shape, name=f"shapes[{k}]") for k, shape in enumerate(shapes)]
    for k, shape in enumerate(checked):
        if shape.shape != V.shape:
            raise ValueError(f"shapes[{k}]: expected {len(V)} vertices as the reference has, got {len(shape)}")
    rings = one_rings(V, F)
    component = vertex_components(F, len(V))
    rotations = np.empty((len(checked), 3, len(V)), np.float32)
    stretches = np.empty((len(checked), 6, len(V)), np.float32)
    bends = np.empty((len(checked), len(V), 3), np.float32)
    offsets = np.empty((len(checked), int(component.max()) + 1, 3))
    for k, shape in enumerate(checked):
        moved = _rigidly_aligned(shape, V) if align else shape
        gradients = rings.displacement_gradients(moved)
        bends[k] = rings.laplacian @ (moved - V) - 0.5 * rings.spread(gradients)
        rotations[k], stretches[k] = rotation_and_stretch(gradients, rings.normal)
        offsets[k] = component_means(moved - V, component)
    return V, F, rotations, stretches, bends, offsets, rings


def component_means(x: Floats, component: NDArray[np.int64]) -> Floats:
    """Mean (c, 3) over each component of values (n, 3)."""
    return np.stack([np.bincount(component, column) for column in x.T], 1) / np.bincount(component)[:, None]


def _rigidly_aligned(P: Floats, V: Floats) -> Floats:
    """``P`` turned and shifted onto ``V``, in the least-squares sense (Kabsch)."""
    with one_thread():
        return (P - P.mean(0)) @ rigid_rotation(P, V).T + V.mean(0)
