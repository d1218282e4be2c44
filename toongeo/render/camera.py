"""The scaled orthographic camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._brief_repr import brief_repr
from toongeo._read_only import restored

__all__ = ["ScaledOrthographicCamera"]

_FLIP = np.array([1.0, -1.0])  # the two rows of P: image y runs down, camera y runs up
_ORTHONORMAL_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class ScaledOrthographicCamera:
    """Scaled orthographic (weak-perspective) camera ``px = scale * P @ rotation @ v + translation``.

    ``P = [[1, 0, 0], [0, -1, 0]]``. The camera frame, ``rotation @ v``, has +X to the right of the image,
    +Y up and +Z towards the viewer. Angles follow ``rotation = Rz(roll) @ Rx(pitch) @ Ry(yaw)``, all
    right-handed and in degrees, which for a head in the model frame means:

    - ``yaw > 0`` turns the face to the subject's own left, which is the right of the image;
    - ``pitch > 0`` nods the face down, so that the crown comes into view;
    - ``roll > 0`` tilts the head counter-clockwise in the image.

    Parameters
    ----------
    scale : float
        Pixels per millimetre, > 0.
    rotation : array_like, shape (3, 3)
        Orthonormal, determinant +1; model frame to camera frame.
    translation : array_like, shape (2,)
        Pixel that the model origin projects to (x right, y down, integer = pixel centre).

    Raises
    ------
    ValueError
        If ``scale`` is not a finite positive number, ``rotation`` is not a proper rotation, or
        ``translation`` is not two finite numbers.

    Examples
    --------
    >>> camera = ScaledOrthographicCamera(2.0, np.eye(3), [10.0, 20.0])
    >>> camera.project([[0.0, 0.0, 5.0], [1.0, 1.0, 5.0]])
    array([[10., 20.],
           [12., 18.]])
    """

    scale: float
    rotation: NDArray[np.float64]
    translation: NDArray[np.float64]

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        scale = float(self.scale)
        if not (np.isfinite(scale) and scale > 0.0):
            raise ValueError(f"scale: expected a finite number > 0 (pixels per mm), got {self.scale!r}")
        rotation = _read_only(self.rotation)
        if rotation.shape != (3, 3) or not np.all(np.isfinite(rotation)):
            raise ValueError(f"rotation: expected a finite (3, 3) array, got shape {rotation.shape}")
        gap = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
        if gap > _ORTHONORMAL_TOLERANCE or np.linalg.det(rotation) < 0.0:
            raise ValueError(
                "rotation: expected an orthonormal matrix with determinant +1, got "
                f"|R R^T - I| = {gap:.3g}, det = {np.linalg.det(rotation):.3g}"
            )
        translation = _read_only(self.translation)
        if translation.shape != (2,) or not np.all(np.isfinite(translation)):
            raise ValueError(f"translation: expected 2 finite numbers (x, y) in px, got {self.translation!r}")
        object.__setattr__(self, "scale", scale)
        object.__setattr__(self, "rotation", rotation)
        object.__setattr__(self, "translation", translation)

    @classmethod
    def look(
        cls,
        yaw: float = 0.0,
        pitch: float = 0.0,
        roll: float = 0.0,
        *,
        size: int | tuple[int, int] = 512,
        centre: ArrayLike = (0.0, 0.0, 0.0),
        extent: float = 260.0,
    ) -> ScaledOrthographicCamera:
        """Camera that frames a head turned by the given angles.

        Parameters
        ----------
        yaw, pitch, roll : float
            Degrees; ``yaw > 0`` turns the face to the subject's left (the right of the image),
            ``pitch > 0`` nods it down, ``roll > 0`` tilts it counter-clockwise in the image.
        size : int or (int, int)
            Image side, or (height, width), in pixels.
        centre : array_like, shape (3,)
            Model point, in mm, that falls on the middle of the image.
        extent : float
            Millimetres that the shorter side of the image spans.

        Returns
        -------
        ScaledOrthographicCamera

        Raises
        ------
        ValueError
            If ``size`` or ``extent`` is not positive, or ``centre`` is not three finite numbers.

        Examples
        --------
        >>> camera = ScaledOrthographicCamera.look(yaw=90.0, size=(100, 200), extent=50.0)
        >>> camera.project([[0.0, 0.0, 0.0], [0.0, 0.0, 10.0]]).round(6)  # the nose points right
        array([[ 99.5,  49.5],
               [119.5,  49.5]])
        """
        height, width = (size, size) if isinstance(size, (int, np.integer)) else size
        if height < 1 or width < 1:
            raise ValueError(f"size: expected positive (height, width) in px, got {size!r}")
        if not (np.isfinite(extent) and extent > 0.0):
            raise ValueError(f"extent: expected a finite length > 0 in mm, got {extent!r}")
        middle = np.asarray(centre, dtype=np.float64)
        if middle.shape != (3,) or not np.all(np.isfinite(middle)):
            raise ValueError(f"centre: expected 3 finite numbers in mm, got {centre!r}")
        scale = min(height, width) / extent
        rotation = _rotation(yaw, pitch, roll)
        image_middle = np.array([(width - 1) / 2.0, (height - 1) / 2.0])
        return cls(scale, rotation, image_middle - scale * _FLIP * (rotation @ middle)[:2])

    def view(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> (k, 3), mm, camera frame (+X right, +Y up, +Z to the viewer)."""
        return _rows(points, 3, "points") @ self.rotation.T

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> (k, 2) px (x right, y down, integer = pixel centre)."""
        return self.view(points)[:, :2] * (self.scale * _FLIP) + self.translation

    def depth(self, points: ArrayLike) -> NDArray[np.float64]:
        """Points (k, 3), mm, model frame -> (k,) mm along the view; larger is nearer to the viewer."""
        return _rows(points, 3, "points") @ self.rotation[2]

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
        seen[:, :2] = (pixels - self.translation) * _FLIP / self.scale
        seen[:, 2] = along
        return seen @ self.rotation

    def jacobian(self, points: ArrayLike) -> NDArray[np.float64]:
        """Derivative (k, 2, 3), px/mm, of the pixels by points (k, 3); the same for all of them."""
        A = (self.scale * _FLIP)[:, None] * self.rotation[:2]
        return np.tile(A, (len(_rows(points, 3, "points")), 1, 1))

    def scaled(self, factor: float) -> ScaledOrthographicCamera:
        """Camera of the same picture resized by ``factor`` (2 = twice as many pixels a side).

        Pixel centres are integers, so a pixel x of the picture lies at ``factor * (x + 0.5) - 0.5`` in the
        resized one.

        Raises
        ------
        ValueError
            If ``factor`` is not a finite number > 0.
        """
        if not (np.isfinite(factor) and factor > 0.0):
            raise ValueError(f"factor: expected a finite number > 0, got {factor!r}")
        return ScaledOrthographicCamera(self.scale * factor, self.rotation, factor * (self.translation + 0.5) - 0.5)

    def cropped(self, corner: ArrayLike, factor: float) -> ScaledOrthographicCamera:
        """Camera whose pixels are ``factor * (px - corner)``."""
        shifted = self.translation - np.asarray(corner, dtype=np.float64)
        return ScaledOrthographicCamera(self.scale * factor, self.rotation, shifted * factor)

    @property
    def yaw(self) -> float:
        """Degrees; > 0 faces the subject's left. Undetermined (0) when looking straight up or down."""
        return float(np.degrees(np.arctan2(-self.rotation[2, 0], self.rotation[2, 2])))

    @property
    def pitch(self) -> float:
        """Degrees in [-90, 90]; > 0 nods down."""
        return float(np.degrees(np.arcsin(np.clip(self.rotation[2, 1], -1.0, 1.0))))

    @property
    def roll(self) -> float:
        """Degrees; > 0 is counter-clockwise in the image."""
        return float(np.degrees(np.arctan2(-self.rotation[0, 1], self.rotation[1, 1])))


def _rotation(yaw: float, pitch: float, roll: float) -> NDArray[np.float64]:
    """``Rz(roll) @ Rx(pitch) @ Ry(yaw)``, degrees."""
    (sy, sp, sr), (cy, cp, cr) = np.sin(angles := np.radians([yaw, pitch, roll])), np.cos(angles)
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cp, -sp], [0.0, sp, cp]])
    about_z = np.array([[cr, -sr, 0.0], [sr, cr, 0.0], [0.0, 0.0, 1.0]])
    return about_z @ about_x @ about_y


def _read_only(values: ArrayLike) -> NDArray[np.float64]:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def _rows(values: ArrayLike, columns: int, name: str) -> NDArray[np.float64]:
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name}: expected shape (k, {columns}), got {array.shape}")
    return array
