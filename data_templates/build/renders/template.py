"""The template as the renderer needs it: head and eyeballs as one mesh, and a chart to paint the skin on.

The chart is the cylinder about the vertical axis at z = -80 mm, unrolled: x grows to the subject's left as in a
picture, y down.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from toongeo.model.default_model import default_model
from toongeo.model.morphable_model import MorphableModel
from toongeo.render.rasterize import Fragments, rasterize

__all__ = ["AXIS_Z", "Template", "template"]

AXIS_Z = -80.0  # mm
_SCALE = 1.6  # chart px per mm: finer than any render shows it
_REACH = 2.0  # rad to either side of the front
_RADIUS = 90.0  # mm, of the cylinder
_TOP = 112.0  # mm above the eyes
_HEIGHT = 302.0  # mm
_JAW_STOP = 18.0  # mm before the bone at the ears: annotators of photographs end the jaw line there
_INSIDE = ("teeth_upper", "teeth_lower", "tongue", "mouth_cavity", "socket_left", "socket_right")


@dataclass(frozen=True, eq=False)
class Template:
    """`faces` (m, 3) of head and both eyeballs; `inside` (n,) vertices of mouth and sockets; `angles` (n,) rad
    about the axis; `chart` (n, 2) px of each vertex on a chart of `chart_shape`, whose texels show `texels`;
    `landmarks` (68, 2) px on the chart; `jaw_last` (17,) the last entry of each contour line that may be used;
    masks (m,) of the head's faces: `in_mouth`, `inner` (any corner inside), and all corners in `sockets`, `teeth`,
    `cavity`, `scalp`."""

    model: MorphableModel
    faces: NDArray[np.int64]
    eye_faces: NDArray[np.int64]
    shell_faces: NDArray[np.int64]
    inside: NDArray[np.bool_]
    angles: NDArray[np.float64]
    chart: NDArray[np.float32]
    chart_shape: tuple[int, int]
    chart_faces: NDArray[np.int64]
    texels: Fragments
    landmarks: NDArray[np.float64]
    jaw_last: tuple[int, ...]
    in_mouth: NDArray[np.bool_]
    inner: NDArray[np.bool_]
    sockets: NDArray[np.bool_]
    teeth: NDArray[np.bool_]
    cavity: NDArray[np.bool_]
    scalp: NDArray[np.bool_]

    def lifted(self, points: NDArray[np.float64], vertices: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (k, 3) on the surface `vertices` (n, 3) for chart points (k, 2) px; NaN outside of the face."""
        height, width = self.chart_shape
        x, y = np.rint(points).astype(int).T
        x, y = x.clip(0, width - 1), y.clip(0, height - 1)
        rows, weights = self.texels.face_ids[y, x], self.texels.barycentrics[y, x]
        out = np.einsum("pk,pkc->pc", weights, vertices[self.chart_faces[rows]])
        out[rows < 0] = np.nan
        return out


@cache
def template() -> Template:
    """The default template, prepared once a process."""
    model = default_model()
    mean, faces = model.mean, model.faces.astype(np.int64)
    inside = np.any([model.region(name) for name in _INSIDE], axis=0)
    angles = np.arctan2(mean[:, 0], mean[:, 2] - AXIS_Z)
    chart = np.column_stack([(np.clip(angles, -_REACH, _REACH) + _REACH) * _RADIUS, _TOP - mean[:, 1]]) * _SCALE
    shape = int(_HEIGHT * _SCALE), int(2 * _REACH * _RADIUS * _SCALE)
    skin = faces[(model.region("skin") & ~inside)[faces].all(1)]
    depth = np.hypot(mean[:, 0], mean[:, 2] - AXIS_Z)
    texels = rasterize(np.column_stack([chart, depth]), skin, *shape, cull_back=True)
    count, eyes = len(mean), model.eyes
    eye_faces = np.vstack([eyes[0].faces + count, eyes[1].faces + count + len(eyes[0].vertices)])
    outer = model.region("skin") | model.region("scalp") | model.region("ears") | model.region("neck")
    teeth = model.region("teeth_upper") | model.region("teeth_lower")
    mouth = teeth | model.region("tongue") | model.region("mouth_cavity")
    return Template(
        model,
        np.vstack([faces, eye_faces]),
        eye_faces,
        faces[(outer & ~inside)[faces].all(1)],
        inside,
        angles,
        chart.astype(np.float32),
        shape,
        skin,
        texels,
        chart[model.landmarks].copy(),
        _jaw_last(model),
        mouth[faces].any(1) & inside[faces].all(1),
        inside[faces].any(1),
        (model.region("socket_left") | model.region("socket_right"))[faces].all(1),
        teeth[faces].all(1),
        model.region("mouth_cavity")[faces].all(1),
        model.region("scalp")[faces].all(1),
    )


def _jaw_last(model: MorphableModel) -> tuple[int, ...]:
    last = []
    for k, line in enumerate(model.contour_lines):
        near_ear = k <= 4 or k >= 12
        allowed = model.mean[line, 2] >= model.mean[model.landmarks[k], 2] + _JAW_STOP
        last.append(int(np.flatnonzero(allowed).max()) if near_ear else len(line) - 1)
    return tuple(last)
