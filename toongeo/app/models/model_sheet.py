"""One picture that shows what a model is."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.model import MorphableModel
from toongeo.render import ScaledOrthographicCamera, Surface, render_mesh

__all__ = ["model_sheet"]

_SIGMA = 2.5  # as far as modes are believed
_N_MODES, _N_EXPRESSIONS = 6, 12
_VIEWS = (("front", 0.0), ("three-quarter", 40.0), ("side", 85.0))
_INK, _POINT = (40, 40, 40), (200, 30, 30)
_COLUMNS = 6
_FILL = 0.9  # of a tile that the mean head takes


def model_sheet(model: MorphableModel, *, tile: int = 280) -> NDArray[np.uint8]:
    """Mean, modes at -2.5 and 2.5 standard deviations, expressions, and landmarks with their numbers, on one sheet.

    Numbers beside the points make a wrong table plain: 36 to 41 run around the subject's right eye, on the left of the
    picture, from its outer corner.

    Parameters
    ----------
    model : MorphableModel
    tile : int
        Side of one picture, px; the landmarks take four.

    Returns
    -------
    (H, 6 tile, 3) uint8 RGB
    """
    coloured = [_picture(model, model.mean, yaw, tile, f"mean, {name}") for name, yaw in _VIEWS]
    clay = [_picture(model, model.mean, yaw, tile, "clay", clay=True) for _, yaw in _VIEWS]
    pictures = [*coloured, *clay]
    for k in range(min(_N_MODES, len(model.identity))):
        for sign in (-1, 1):
            V = model.mean + sign * _SIGMA * model.identity[k]
            pictures.append(_picture(model, V, 20.0, tile, f"mode {k}, {sign * _SIGMA:+.1f}", clay=True))
    for k in range(min(_N_EXPRESSIONS, len(model.expression))):
        V = model.mean + (1.0 if k < model.n_named else _SIGMA) * model.expression[k]
        pictures.append(_picture(model, V, 0.0, tile, model.expression_names[k], clay=True))
    blank = np.full((tile, tile, 3), 255, np.uint8)
    pictures += [blank] * (-len(pictures) % _COLUMNS)
    rows = [np.hstack(pictures[k : k + _COLUMNS]) for k in range(0, len(pictures), _COLUMNS)]
    if model.has("landmarks"):
        half = _COLUMNS * tile // 2
        rows.append(np.hstack([_numbered(model, yaw, half) for yaw in (0.0, 35.0)]))
    return np.vstack(rows)


def _camera(model: MorphableModel, yaw: float, tile: int) -> ScaledOrthographicCamera:
    low, high = model.mean.min(axis=0), model.mean.max(axis=0)
    rotation = ScaledOrthographicCamera.look(yaw=yaw).rotation
    scale = _FILL * tile / float(np.linalg.norm((high - low)[:2]))
    middle = rotation @ ((low + high) / 2)
    return ScaledOrthographicCamera(scale, rotation, tile / 2 - scale * middle[:2] * [1, -1])


def _picture(
    model: MorphableModel, V: NDArray[np.float64], yaw: float, tile: int, title: str, *, clay: bool = False
) -> NDArray[np.uint8]:
    surface = Surface(V.astype(np.float64), model.faces, colours=None if clay else model.albedo_mean)
    view = render_mesh(surface, _camera(model, yaw, tile), tile, shading="clay" if clay else "lit")
    return _titled(view, title)


def _titled(view: NDArray[np.uint8], title: str) -> NDArray[np.uint8]:
    view = np.ascontiguousarray(view)
    cv2.putText(view, title, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.45, _INK, 1, cv2.LINE_AA)
    return view


def _numbered(model: MorphableModel, yaw: float, side: int) -> NDArray[np.uint8]:
    """The face, filling the picture, with its landmarks."""
    points = model.mean[model.landmarks]
    rotation = ScaledOrthographicCamera.look(yaw=yaw).rotation
    seen = points @ rotation.T
    scale = _FILL * side / max(float(np.ptp(seen[:, :2], axis=0).max()), 1.0)
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    camera = ScaledOrthographicCamera(scale, rotation, side / 2 - scale * middle[:2] * [1, -1])
    view = np.ascontiguousarray(render_mesh(Surface(model.mean, model.faces), camera, side, shading="clay"))
    for k, (x, y) in enumerate(camera.project(points)):
        cv2.circle(view, (round(x), round(y)), 3, _POINT, -1, cv2.LINE_AA)
        cv2.putText(view, str(k), (round(x) + 4, round(y) - 3), cv2.FONT_HERSHEY_SIMPLEX, 0.4, _INK, 1, cv2.LINE_AA)
    return _titled(view, f"landmarks, {yaw:.0f} degrees")
