"""The perspective camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo.render.camera import ScaledOrthographicCamera

__all__ = ["PerspectiveCamera"]

_FLIP = np.array([1.0, -1.0])  # image y runs down, camera y runs up


@dataclass(frozen=True, eq=False)
class PerspectiveCamera:
    """Pinhole camera ``px = principal_point + focal_px * P y / -y_z`` with ``y = rotation @ v + translation``.

    ``P = [[1, 0, 0], [0, -1, 0]]``. The camera frame has +X to the right of the image, +Y up and +Z towards the
    viewer, who is at its origin: what is seen has a negative Z. Angles are those of `ScaledOrthographicCamera`,
    to which this one tends as ``focal_px`` and the distance grow alike.

    Parameters
    ----------
    focal_px : float
        Focal length in pixels, > 0.
    rotation : array_like, shape (3, 3)
        Orthonormal, determinant +1; model frame to camera frame.
    translation : array_like, shape (3,)
        The model origin in the camera frame, mm; z < 0.
    principal_point : array_like, shape (2,)
        Pixel of the optical axis (x right, y down, integer = pixel centre).

    Raises
    ------
    ValueError
        If ``focal_px`` is not a finite positive number, ``rotation`` is not a proper rotation, or the others are
        not finite or the model lies behind the viewer.

    Examples
    --------
    >>> camera = PerspectiveCamera(500.0, np.eye(3), [0.0, 0.0, -1000.0], [10.0, 20.0])
    >>> camera.project([[0.0, 0.0, 0.0], [1.0, 1.0, 500.0]])
    array([[10., 20.],
           [11., 19.]])
    """

    focal_px: float
    rotation: NDArray[np.float64]
    translation: NDArray[np.float64]
    principal_point: NDArray[np.float64]

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        focal = float(self.focal_px)
        if not (np.isfinite(focal) and focal > 0.0):
            raise ValueError(f"focal_px: expected a finite number > 0, got {self.focal_px!r}")
        upright = ScaledOrthographicCamera(1.0, self.rotation, np.zeros(2))  # checks the rotation
        translation = _vector(self.translation, 3, "translation", "(x, y, z) in mm")
        if not translation[2] < 0.0:
            raise ValueError(f"translation: expected z < 0, the model before the viewer, got {translation[2]}")
        point = _vector(self.principal_point, 2, "principal_point", "(x, y) in px")
        object.__setattr__(self, "focal_px", focal)
        object.__setattr__(self, "rotation", upright.rotation)
        object.__setattr__(self, "translation", translation)
        object.__setattr__(self, "principal_point", point)

    def view(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> (k, 3), mm, camera frame (+X right, +Y up, +Z to the viewer)."""
        return _rows(points, 3, "points") @ self.rotation.T + self.translation

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> (k, 2) px; NaN for points that are not before the viewer."""
        seen = self.view(points)
        return self.principal_point + seen[:, :2] * _FLIP * (self.focal_px / _distance(seen))[:, None]

    def depth(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> (k,) mm along the view; larger is nearer, 0 is the viewer."""
        return self.view(points)[:, 2]

    def unproject(self, px: ArrayLike, depth: ArrayLike) -> NDArray[np.float64]:
        """Inverse of `project` and `depth` together.

        Parameters
        ----------
        px : array_like, shape (k, 2)
            Pixels.
        depth : array_like, shape (k,)
            Millimetres as `depth` gives them; a single number serves all rows.

        Returns
        -------
        ndarray, shape (k, 3)
            Model frame, mm.

        Raises
        ------
        ValueError
            If the shapes do not fit.
        """
        pixels = _rows(px, 2, "px")
        along = np.asarray(depth, dtype=np.float64)
        if along.shape not in ((), (len(pixels),)):
            raise ValueError(f"depth: expected shape ({len(pixels)},) to go with px, got {along.shape}")
        seen = np.empty((len(pixels), 3))
        seen[:, 2] = along
        seen[:, :2] = (pixels - self.principal_point) * _FLIP * (-seen[:, 2:] / self.focal_px)
        return (seen - self.translation) @ self.rotation

    def jacobian(self, points: ArrayLike) -> NDArray[np.float64]:
        """Derivative (k, 2, 3), px/mm, of the pixels by points (k, 3)."""
        seen = self.view(points)
        distance = _distance(seen)
        J = np.zeros((len(seen), 2, 3))
        J[:, 0, 0] = J[:, 1, 1] = 1.0
        J[:, :, 2] = seen[:, :2] / distance[:, None]
        J *= _FLIP[:, None] * (self.focal_px / distance)[:, None, None]
        return J @ self.rotation

    def cropped(self, corner: ArrayLike, factor: float) -> PerspectiveCamera:
        """Camera whose pixels are ``factor * (px - corner)``."""
        point = (self.principal_point - np.asarray(corner, dtype=np.float64)) * factor
        return PerspectiveCamera(self.focal_px * factor, self.rotation, self.translation, point)

    def scaled(self, factor: float) -> PerspectiveCamera:
        """Camera of the same picture resized by ``factor`` (2 = twice as many pixels a side).

        A pixel x of the picture lies at ``factor * (x + 0.5) - 0.5`` in the resized one.

        Raises
        ------
        ValueError
            If ``factor`` is not a finite number > 0.
        """
        if not (np.isfinite(factor) and factor > 0.0):
            raise ValueError(f"factor: expected a finite number > 0, got {factor!r}")
        point = factor * (self.principal_point + 0.5) - 0.5
        return PerspectiveCamera(self.focal_px * factor, self.rotation, self.translation, point)

    @property
    def yaw(self) -> float:
        """Degrees; > 0 faces the subject's left. Undetermined (0) when looking straight up or down."""
        return self._turned.yaw

    @property
    def pitch(self) -> float:
        """Degrees in [-90, 90]; > 0 nods down."""
        return self._turned.pitch

    @property
    def roll(self) -> float:
        """Degrees; > 0 is counter-clockwise in the image."""
        return self._turned.roll

    @property
    def _turned(self) -> ScaledOrthographicCamera:
        return ScaledOrthographicCamera(1.0, self.rotation, np.zeros(2))


def _distance(seen: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance (k,) from the viewer along the axis; NaN where it is not positive."""
    return np.where(seen[:, 2] < 0.0, -seen[:, 2], np.nan)


def _vector(values: ArrayLike, size: int, name: str, meaning: str) -> NDArray[np.float64]:
    array = np.array(values, dtype=np.float64)
    if array.shape != (size,) or not np.all(np.isfinite(array)):
        raise ValueError(f"{name}: expected {size} finite numbers {meaning}, got {values!r}")
    array.setflags(write=False)
    return array


def _rows(values: ArrayLike, columns: int, name: str) -> NDArray[np.float64]:
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name}: expected shape (k, {columns}), got {array.shape}")
    return array
