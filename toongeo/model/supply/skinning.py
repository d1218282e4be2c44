"""Parts of a head that turn about joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.geometry.rotations.rotation_exp import rotation_exp

__all__ = ["Skinning"]


@dataclass(frozen=True, eq=False)
class Skinning:
    """Linear blend skinning with correctives that are linear in the rotations (T. Li et al. 2017, Eq. 2-4).

    Attributes
    ----------
    names : tuple of j names
        Of the joints, parents before their children.
    parents : (j,) int64
        -1 for a joint without.
    regressor : (j, n) float64
        Joints as affine combinations of the vertices: rows sum to 1.
    weights : (n, j) float64
        How far a vertex goes with each joint; rows sum to 1.
    correctives : (9 (j - 1), n, 3) float32, mm
        Displacement a unit of the rotation matrices less the identity, row by row, of all joints but the first.

    Raises
    ------
    ValueError
        If shapes do not fit, rows do not sum to 1, or a parent comes after its child.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    regressor: NDArray[np.float64]
    weights: NDArray[np.float64]
    correctives: NDArray[np.float32]

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        j, n = len(self.names), self.weights.shape[0]
        for name, shape in {
            "parents": (j,),
            "regressor": (j, n),
            "weights": (n, j),
            "correctives": (9 * (j - 1), n, 3),
        }.items():
            if getattr(self, name).shape != shape:
                raise ValueError(f"{name}: expected shape {shape}, got {getattr(self, name).shape}")
        if not j or (self.parents >= np.arange(j)).any() or (self.parents < -1).any():
            raise ValueError(f"parents: expected -1 or an earlier joint for each, got {self.parents.tolist()}")
        for name in ("regressor", "weights"):
            if not np.allclose(getattr(self, name).sum(axis=1), 1, atol=1e-3):
                raise ValueError(f"{name}: expected rows that sum to 1")
        if not np.isfinite(self.correctives).all():
            raise ValueError("correctives: expected finite numbers, got NaN or infinity")
        read_only(self, *(field.name for field in fields(self) if field.name != "names"))

    def posed(self, vertices: NDArray[np.float64], pose: Mapping[str, ArrayLike]) -> NDArray[np.float64]:
        """Vertices (n, 3), mm, of a head whose joints are turned.

        Parameters
        ----------
        vertices : (n, 3) float, mm
            At rest, in the shape and expression of the face.
        pose : name -> (3,) rotation vector
            Radians, model frame; joints that are not named stay.

        Raises
        ------
        ValueError
            If a joint is not known, or a rotation is no (3,).
        """
        turned = np.zeros((len(self.names), 3))
        for name, vector in pose.items():
            if name not in self.names:
                raise ValueError(f"pose: expected joints {', '.join(self.names)}, got {name!r}")
            if np.shape(vector) != (3,) or not np.isfinite(vector).all():
                raise ValueError(f"pose: expected a rotation vector (3,) for {name!r}, got {vector!r}")
            turned[self.names.index(name)] = vector
        R = np.moveaxis(rotation_exp(turned.T), 2, 0)
        joints = self.regressor @ vertices
        offsets = np.tensordot((R[1:] - np.eye(3)).ravel(), self.correctives, 1)  # Eq. 4
        rotations, shifts = np.empty_like(R), np.empty((len(R), 3))
        for j, parent in enumerate(self.parents):
            # Where the joint takes a point x: rotations @ x + shifts.
            about = joints[j] - R[j] @ joints[j]
            rotations[j] = R[j] if parent < 0 else rotations[parent] @ R[j]
            shifts[j] = about if parent < 0 else rotations[parent] @ about + shifts[parent]
        blended = np.einsum("nj,jab->nab", self.weights, rotations)
        return np.asarray(np.einsum("nab,nb->na", blended, vertices + offsets) + self.weights @ shifts)
