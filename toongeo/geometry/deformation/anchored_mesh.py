"""What the two forms of Laplacian alignment share: checks, the system's matrix, and its right-hand side."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.deformation.loose_parts import loose_parts
from toongeo.geometry.operators.components import components
from toongeo.geometry.operators.cotangent_laplacian import cotangent_laplacian
from toongeo.geometry.operators.uniform_laplacian import uniform_laplacian
from toongeo.geometry.rotations.ring_rotations import ring_rotations
from toongeo.geometry.validate_mesh import MeshLike, validate_mesh

__all__ = [
    "AnchoredMesh",
    "DEFAULT_WEIGHT",
    "add_anchors",
    "anchored_mesh",
    "checked_rotations",
    "checked_targets",
    "turned_pull",
]

# lambda of Eq. 10, which the paper does not tell. An anchor stops where the pull of the surface meets lambda
# times its residual. As L has a unit diagonal the pull is a fraction of the displacement, 0.08 of it on a
# face of 17,000 vertices, so 1000 leaves 1e-4 of the displacement and less than 1e-5 of the face's size.
DEFAULT_WEIGHT = 1e3

# Smallest weight of an edge of the cotangent Laplacian here: negative ones make rings indefinite, tiny ones
# tear the mesh apart.
_CLAMP = 1e-2


@dataclass(frozen=True, eq=False)
class AnchoredMesh:
    """A checked mesh with its anchors; `k` given ones, `a` different ones."""

    V: NDArray[np.float64]
    given: NDArray[np.int64]  # (k,) vertex indices as they came
    weight: NDArray[np.float64]  # (k,)
    anchors: NDArray[np.int64]  # (a,) the different ones, sorted
    group: NDArray[np.int64]  # (k,) given -> anchors
    parts: NDArray[np.int64]  # (n,) component number of each vertex
    component: NDArray[np.int64]  # (a,) that of each anchor
    moving: NDArray[np.int64]  # vertices of the components that hold an anchor, but for the fixed ones
    position: NDArray[np.int64]  # (a,) anchors as indices into `moving`
    laplacian: sp.csr_matrix  # (n, n)
    columns: sp.csr_matrix  # of the Laplacian, those of the moving vertices
    gram: sp.csr_matrix  # their products
    loose: list[tuple[NDArray[np.int64], NDArray[np.int64]]]  # parts that follow, each with what it follows

    @cached_property
    def graph(self) -> sp.csr_matrix:
        """Adjacency (n, n): every edge has a weight in the Laplacian."""
        A = sp.csr_matrix((self.laplacian != 0).astype(np.float64))
        A.setdiag(0.0)
        return A

    def pull(
        self, targets: NDArray[np.float64], rest: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Displacement wanted (a, 3) and weight (a,) of every different anchor; both 0 where missing."""
        present = np.asarray(np.isfinite(targets).all(axis=1))
        merged = np.zeros((len(self.anchors), 3))
        merged[self.group[present]] = targets[present]
        differs = present & (merged[self.group] != targets).any(axis=1)
        if differs.any():
            vertex = self.given[differs.argmax()]
            rows = np.flatnonzero((self.given == vertex) & present).tolist()
            raise ValueError(
                f"targets: expected one target an anchor, got different ones for vertex {vertex} (rows {rows})"
            )
        weight = self.total_weight(present)
        if not weight.any():
            raise ValueError("weight: expected a target with a weight above 0, got none")
        return np.where(weight[:, None] > 0, merged - rest[self.anchors], 0.0), weight

    def total_weight(self, present: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Weight (a,) of the different anchors: that of a repeated one adds up, as in the sum of Eq. 10."""
        weight = np.where(present, self.weight, 0.0)
        return np.bincount(self.group, weight, minlength=len(self.anchors)).astype(np.float64)


def anchored_mesh(
    V: MeshLike,
    F: ArrayLike | None,
    anchors: ArrayLike,
    weight: ArrayLike,
    laplacian: str,
    fixed: ArrayLike | None = None,
    loose: str = "stay",
) -> AnchoredMesh:
    """Check everything and assemble ``L^T L`` on the components that hold an anchor."""
    V, F = validate_mesh(V, F)
    given = _checked_anchors(anchors, len(V))
    weights = _checked_weight(weight, len(given))
    held = _checked_fixed(fixed, len(V), given)
    if loose not in ("stay", "follow"):
        raise ValueError(f"loose: expected 'stay' or 'follow', got {loose!r}")
    unique, group = np.unique(given, return_inverse=True)
    L = _unit_laplacian(V, F, laplacian)
    component = components(F, len(V))
    # A component without an anchor would make the system singular; left out, it stays exactly where it is.
    anchored = np.isin(component, component[unique])
    moving = np.flatnonzero(anchored & ~held)
    columns = L if len(moving) == len(V) else sp.csr_matrix(L[:, moving])
    held_parts = np.isin(component, component[np.flatnonzero(anchored | held)])
    return AnchoredMesh(
        V=V,
        given=given,
        weight=weights,
        anchors=unique,
        group=group,
        parts=component,
        component=component[unique],
        moving=moving,
        position=np.searchsorted(moving, unique),
        laplacian=L,
        columns=columns,
        gram=sp.csr_matrix(columns.T @ columns),
        loose=loose_parts(V, component, held_parts) if loose == "follow" and not held_parts.all() else [],
    )


def add_anchors(mesh: AnchoredMesh, weight: ArrayLike) -> sp.csr_matrix:
    """``K = L^T L + S^T W S``, positive definite for positive weights."""
    diagonal = np.zeros(len(mesh.moving))
    diagonal[mesh.position] = weight
    return sp.csr_matrix(mesh.gram + sp.diags_array(diagonal))


def turned_pull(mesh: AnchoredMesh, rest: NDArray[np.float64], moved: NDArray[np.float64]) -> NDArray[np.float64]:
    """``L^T (R L v - L v)`` (rows of `moving`), R the rotations from one shape to the other around each vertex."""
    delta = mesh.laplacian @ rest
    R = ring_rotations(mesh.graph, rest, moved)
    return np.asarray(mesh.columns.T @ (np.einsum("nij,nj->ni", R, delta) - delta))


def checked_rotations(rotations: int) -> int:
    """The number of times that rotations are estimated."""
    if isinstance(rotations, bool) or not isinstance(rotations, (int, np.integer)) or rotations < 0:
        raise ValueError(f"rotations: expected an integer >= 0, got {rotations!r}")
    return int(rotations)


def checked_targets(targets: ArrayLike, k: int) -> NDArray[np.float64]:
    """(k, 3) targets, finite or NaN, not all missing."""
    targets = np.asarray(targets, dtype=np.float64)
    if targets.shape != (k, 3):
        raise ValueError(f"targets: expected shape ({k}, 3), a row an anchor, got {targets.shape}")
    infinite = np.isinf(targets).any(axis=1)
    if infinite.any():
        raise ValueError(f"targets: expected finite or NaN values, got infinity in row {infinite.argmax()}")
    if np.isnan(targets).any(axis=1).all():
        raise ValueError("targets: expected at least one row without NaN, got none (every anchor is missing)")
    return targets


def _unit_laplacian(V: NDArray[np.float64], F: NDArray[np.int64], name: str) -> sp.csr_matrix:
    """A Laplacian with unit diagonal, as Eq. 9 has."""
    if name == "uniform":
        return uniform_laplacian(F, len(V))
    if name == "cotangent":
        C = cotangent_laplacian(V, F, clamp=_CLAMP)
        diagonal = C.diagonal()
        return sp.csr_matrix(sp.diags_array(1 / np.where(diagonal > 0, diagonal, 1.0)) @ C)
    raise ValueError(f"laplacian: expected 'uniform' or 'cotangent', got {name!r}")


def _checked_anchors(anchors: ArrayLike, n: int) -> NDArray[np.int64]:
    anchors = np.asarray(anchors)
    if anchors.ndim != 1 or len(anchors) == 0 or anchors.dtype.kind not in "iu":
        raise ValueError(f"anchors: expected integers of shape (k,), k >= 1, got {anchors.dtype} {anchors.shape}")
    outside = (anchors < 0) | (anchors >= n)
    if outside.any():
        raise ValueError(f"anchors: expected vertex indices in 0..{n - 1}, got {anchors[outside.argmax()]}")
    return anchors.astype(np.int64)


def _checked_weight(weight: ArrayLike, k: int) -> NDArray[np.float64]:
    weight = np.asarray(weight, dtype=np.float64)
    if weight.shape not in ((), (k,)):
        raise ValueError(f"weight: expected a number or shape ({k},), got shape {weight.shape}")
    bad = ~(weight >= 0)
    if bad.any():
        raise ValueError(f"weight: expected numbers >= 0 (infinity: met exactly), got {weight[bad].flat[0]}")
    if not weight.any():
        raise ValueError("weight: expected an anchor with a weight above 0, got only zeros")
    return np.broadcast_to(weight, (k,)).copy()


def _checked_fixed(fixed: ArrayLike | None, n: int, anchors: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Mask (n,) of the fixed vertices."""
    held = np.zeros(n, bool)
    if fixed is None:
        return held
    rows = np.asarray(fixed)
    mask = rows.dtype == bool and rows.shape == (n,)
    if not mask and not (rows.ndim == 1 and (rows.dtype.kind in "iu" or len(rows) == 0)):
        raise ValueError(f"fixed: expected a mask ({n},) or vertex indices (k,), got {rows.dtype} {rows.shape}")
    rows = np.flatnonzero(rows) if mask else rows.astype(np.int64)
    outside = (rows < 0) | (rows >= n)
    if outside.any():
        raise ValueError(f"fixed: expected vertex indices in 0..{n - 1}, got {rows[outside.argmax()]}")
    held[rows] = True
    if held[anchors].any():
        raise ValueError(f"fixed: expected no anchor among the fixed vertices, got {anchors[held[anchors].argmax()]}")
    return held
