"""The atlas of a shell: the picture where it shows hair, strands elsewhere."""

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Integers, Reals
from toongeo.geometry import vertex_normals
from toongeo.pipeline.hair.colours.other_side import other_side
from toongeo.pipeline.hair.colours.panels import Texels, panels, texels
from toongeo.pipeline.hair.colours.picture_colours import PictureColours
from toongeo.pipeline.hair.colours.strand_frame import StrandFrame
from toongeo.pipeline.hair.plane.masks import nearest_set
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane
from toongeo.pipeline.hair.shell.shell_mesh import ShellMesh
from toongeo.render import sample_image

__all__ = ["hair_texture"]


_UNSEEN = 1.25  # texels per mm where the picture shows nothing
_BEHIND = (-0.2, 0.5)  # cosines away from the viewer between which lights of the picture fade
_TURNED = (0.3, 0.6)  # cosines to the viewer between which the picture takes over from strands


def hair_texture(
    plane: WorkingPlane, mesh: ShellMesh, colours: PictureColours, frame: StrandFrame, strands: NDArray[np.float32]
) -> tuple[NDArray[np.uint8], Reals, Integers]:
    """Atlas (H, W, 3) uint8, coordinates (t, 2) and corners (m, 3) into them.

    ``strands`` (along, across, 3) is what strands add to the colours, on the whole breadth of the frame's map.
    """
    density = 1.0 / colours.cell_mm
    normals = vertex_normals(mesh.vertices, mesh.faces)
    found = panels(mesh, normals, density, _UNSEEN)
    pictures, corners = [], np.zeros_like(mesh.faces)
    places = []
    count = left = 0
    for panel in found:
        inside = texels(panel, mesh, normals)
        painted = np.zeros((panel.shape[0] * panel.shape[1], 3), np.float32)
        painted[inside.number] = _colours(plane, mesh, inside, colours, frame, strands)
        covered = np.zeros(len(painted), bool)
        covered[inside.number] = True
        pictures.append(nearest_set(painted.reshape(*panel.shape, 3), covered.reshape(panel.shape)))
        used, local = np.unique(mesh.faces[panel.rows], return_inverse=True)
        corners[panel.rows] = local.reshape(-1, 3) + count
        places.append(panel.places(mesh.vertices[used]) + [left, 0])
        count += len(used)
        left += panel.shape[1]
    height = max(panel.shape[0] for panel in found)
    atlas = np.hstack([np.pad(p, ((0, height - len(p)), (0, 0), (0, 0)), mode="edge") for p in pictures])
    uv = (np.vstack(places) + 0.5) / [left, height]
    return np.clip(np.rint(atlas[::-1]), 0, 255).astype(np.uint8), uv, corners


def _colours(
    plane: WorkingPlane,
    mesh: ShellMesh,
    inside: Texels,
    colours: PictureColours,
    frame: StrandFrame,
    strands: NDArray[np.float32],
) -> NDArray[np.float32]:
    """Colours (k, 3) of texels."""
    at = (inside.points[:, :2] - plane.low) / colours.cell_mm
    broad, plain = (sample_image(layer, at) for layer in (colours.broad, colours.plain))
    mirrored, hidden = other_side(plane, inside.points)
    if hidden.any():
        other = (mirrored[:, :2] - plane.low) / colours.cell_mm
        weight = hidden[:, None].astype(np.float32)
        broad += weight * (sample_image(colours.broad, other) - broad)
        plain += weight * (sample_image(colours.plain, other) - plain)
    across, along = frame.at(plane.back(inside.points))
    per_mm = strands.shape[1] / frame.breadth
    rows = np.abs(np.mod(along * per_mm + len(strands), 2 * len(strands)) - len(strands))  # there and back again
    detail = sample_image(strands, np.column_stack([across * per_mm, rows]))
    seen = (mesh.front & mesh.shown)[inside.triangle]
    behind = _ramp(-inside.normals[:, 2], *_BEHIND)
    share = _ramp(inside.normals[:, 2], *_TURNED) * seen[:, None]
    painted = broad + behind * (plain - broad) + detail
    pictured = np.flatnonzero(share > 0)
    painted[pictured] += share[pictured] * (sample_image(colours.drawn, at[pictured]) - painted[pictured])
    return np.asarray(painted, np.float32)


def _ramp(values: Reals, low: float, high: float) -> NDArray[np.float32]:
    """0 (k, 1) below, 1 above, smooth in between."""
    t = np.clip((values - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t), np.float32)[:, None]
