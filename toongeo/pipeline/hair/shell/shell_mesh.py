"""The shell of hair: two sheets on one rim."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Integers
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane
from toongeo.pipeline.hair.shell.edges import boundary_edges, edges_of, halved
from toongeo.pipeline.hair.shell.faired import faired
from toongeo.pipeline.hair.shell.planar_mesh import planar_mesh
from toongeo.pipeline.hair.shell.regions import HeadRaster, Regions
from toongeo.pipeline.hair.shell.sheet_rasters import SheetRasters
from toongeo.pipeline.hair.shell.sheets import Sheets, sheets

__all__ = ["ShellMesh", "shell_mesh"]

Floats = NDArray[np.floating]

_LONGEST_MM = 10.0  # of an edge that is seen
_MOST = 6_800  # triangles of a sheet, so that both have less than 15,000


@dataclass(frozen=True, eq=False)
class ShellMesh:
    """A closed mesh in the plane's frame.

    Attributes
    ----------
    vertices : (n, 3) float64, mm
    faces : (m, 3) int64
        Those of the front sheet, then those of the back sheet.
    front : (m,) bool
    shown : (m,) bool
        False where a sheet only lines the other or hides in the head.
    """

    vertices: Floats
    faces: Integers
    front: NDArray[np.bool_]
    shown: NDArray[np.bool_]


def shell_mesh(plane: WorkingPlane, parts: Regions, head: HeadRaster) -> ShellMesh:
    """Closed and edge-manifold by construction: both sheets are heights over the same triangles.

    They share the vertices on the rim and no others, and as the front is nowhere behind the back, they do not cross.
    """
    rasters = SheetRasters(plane, parts, head)
    P, T = planar_mesh(plane, parts.whole, (parts.front, parts.back))
    P, T = halved(P, T, _long_edges(sheets(P, T, rasters), (_MOST - len(T)) // 2))
    P, T = halved(P, T, _chords(T))
    return _joined(faired(sheets(P, T, rasters), rasters))


def _long_edges(both: Sheets, most: int) -> NDArray[np.bool_]:
    """Edges (of ``edges_of``) of shown triangles that are long on either sheet; the longest, at most so many."""
    edges, number, _ = edges_of(both.triangles)
    longest = np.zeros(len(edges))
    for z, shown in ((both.front, both.front_shown), (both.back, both.back_shown)):
        X = np.column_stack([both.points, z])
        length = np.linalg.norm(X[edges[:, 0]] - X[edges[:, 1]], axis=1)
        seen = np.unique(number[shown])
        longest[seen] = np.maximum(longest[seen], length[seen])
    bound = np.sort(longest)[-min(max(most, 1), len(longest))]
    return longest > max(bound, _LONGEST_MM)


def _chords(T: Integers) -> NDArray[np.bool_]:
    """Edges inside with both ends on the rim, which both sheets would share."""
    edges, _, count = edges_of(T)
    rim = np.zeros(T.max() + 1, bool)
    rim[boundary_edges(T)] = True
    return rim[edges].all(1) & (count == 2)


def _joined(both: Sheets) -> ShellMesh:
    n, T = len(both.points), both.triangles
    rim = np.zeros(n, bool)
    rim[boundary_edges(T)] = True
    inner = np.flatnonzero(~rim)
    behind = np.arange(n)
    behind[inner] = n + np.arange(len(inner))
    front, back = (np.column_stack([both.points, z]) for z in (both.front, both.back))
    vertices = np.vstack([front, back[inner]])
    faces = np.vstack([T, behind[T][:, [0, 2, 1]]])
    return ShellMesh(vertices, faces, np.arange(len(faces)) < len(T), np.r_[both.front_shown, both.back_shown])
