"""Five views of a shell side by side in one atlas: each triangle lies in the view that it faces."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Integers, Reals
from toongeo.pipeline.hair.shell.shell_mesh import ShellMesh
from toongeo.render import interpolate, rasterize

__all__ = ["Panel", "Texels", "panels", "texels"]


# Directions in the plane's frame: to the right of the view, up in it, and towards its viewer.
_VIEWS = np.array(
    [
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]],  # front
        [[-1, 0, 0], [0, 1, 0], [0, 0, -1]],  # back
        [[0, 0, -1], [0, 1, 0], [1, 0, 0]],  # right in the picture
        [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],  # left in the picture
        [[1, 0, 0], [0, 0, -1], [0, 1, 0]],  # above
    ],
    np.float64,
)
_FRONT = 0.4  # cosine to the viewer from which a triangle that the picture shows takes the picture
_GUTTER = 3  # texels about a panel, of its own colours


@dataclass(frozen=True, eq=False)
class Panel:
    """A parallel view of some triangles.

    Attributes
    ----------
    rows : (k,) int64
        Its triangles.
    view : (3, 3) float64
        Rows: right, up, towards the viewer.
    low : (2,) float64
        mm in the view, at the texel (0, 0), which is the lowest on the left.
    density : float
        Texels per mm.
    shape : (rows, columns)
    """

    rows: Integers
    view: Reals
    low: Reals
    density: float
    shape: tuple[int, int]

    def places(self, X: Reals) -> Reals:
        """Column and row from below (n, 2), texels, of points (n, 3) in the plane's frame."""
        return np.asarray(((X @ self.view.T)[:, :2] - self.low) * self.density)


@dataclass(frozen=True, eq=False)
class Texels:
    """What lies in the texels (k,) of a panel: their number, triangle, point (k, 3) and unit normal (k, 3)."""

    number: Integers
    triangle: Integers
    points: Reals
    normals: Reals


def panels(mesh: ShellMesh, normals: Reals, front_density: float, density: float) -> list[Panel]:
    """The panels that have triangles; the front one has a density of its own, texels per mm.

    ``normals`` (n, 3) are those of the vertices.
    """
    V, F = mesh.vertices, mesh.faces
    facing = normals[F].mean(1) @ _VIEWS[:, 2].T
    seen = mesh.front & mesh.shown
    # The picture is stretched where the hair turns away, and shows nothing of what lies behind.
    facing[:, 0] = np.where(seen & (facing[:, 0] > _FRONT), 2.0, np.where(mesh.front, facing[:, 0] - 1.0, -2.0))
    number = facing.argmax(1)
    found = []
    for k, view in enumerate(_VIEWS):
        rows = np.flatnonzero(number == k)
        if not len(rows):
            continue
        per_mm = front_density if k == 0 else density
        at = (V[F[rows]].reshape(-1, 3) @ view.T)[:, :2]
        low, high = at.min(0) - _GUTTER / per_mm, at.max(0) + _GUTTER / per_mm
        columns, height = (np.ceil((high - low) * per_mm).astype(int) + 1).tolist()
        found.append(Panel(rows, view, low, per_mm, (height, columns)))
    return found


def texels(panel: Panel, mesh: ShellMesh, normals: Reals) -> Texels:
    """What lies in each texel that a panel's triangles cover; the outermost where several do."""
    F = mesh.faces[panel.rows]
    depth = mesh.vertices @ panel.view[2]
    fragments = rasterize(np.column_stack([panel.places(mesh.vertices), depth]), F, *panel.shape)
    number = np.flatnonzero(fragments.mask)
    at = interpolate(fragments, F, np.column_stack([mesh.vertices, normals])).reshape(-1, 6)[number]
    turned = at[:, 3:] / np.maximum(np.linalg.norm(at[:, 3:], axis=1, keepdims=True), 1e-9)
    return Texels(number, panel.rows[fragments.face_ids.ravel()[number]], at[:, :3], turned)
