"""Frames of a face for streams."""

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from toongeo.geometry import vertex_normals
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.pipeline.rig.add_rows import add_rows
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes
from toongeo.pipeline.rig.rig import Rig

__all__ = ["Animator", "Rigged"]

_Weights = Mapping[str, float] | np.ndarray | None


class Rigged(Protocol):
    """What an :class:`toongeo.Avatar` has of interest here."""

    @property
    def rig(self) -> Rig:
        """Blendshapes of the head."""

    @property
    def eyes(self) -> Eyes:
        """Both eyeballs."""

    @property
    def faces(self) -> np.ndarray:
        """Triangles of the head."""


class Animator:
    """Evaluates the frames of one face fast: ``S* = S_0 + B beta`` (Pan et al. 2024, Eq. 13) in float32.

    Rows of B whose weight is zero are not read.

    Parameters
    ----------
    avatar : Avatar
    limits : (low, high) or None
        _Weights are brought into this range: trackers overshoot. The templates are made for [0, 1]; caricatures take
        (0, 1.5). None leaves them as they are.

    Raises
    ------
    ValueError
        If the limits are not two finite numbers, the lower first.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> rig = Rig(("jawOpen",), np.zeros((3, 3)), np.ones((1, 3, 3), np.float32), np.zeros((8, 3, 3), np.float32),
    ...           np.zeros(1), {})
    >>> animator = Animator(SimpleNamespace(rig=rig, eyes=None, faces=np.array([[0, 1, 2]])), limits=(0, 1.5))
    >>> animator.frame({"jawOpen": 2})[0]
    array([1.5, 1.5, 1.5], dtype=float32)
    """

    def __init__(self, avatar: Rigged, *, limits: tuple[float, float] | None = (0.0, 1.0)) -> None:
        if limits is not None and not (
            np.shape(limits) == (2,) and np.isfinite(limits).all() and limits[0] < limits[1]
        ):
            raise ValueError(f"limits: expected (low, high), finite, low < high, or None, got {limits!r}")
        self.rig, self.eyes, self.faces, self.limits = avatar.rig, avatar.eyes, avatar.faces, limits
        self._neutral = self.rig.neutral.astype(np.float32).ravel()
        shapes = np.concatenate([self.rig.deltas, self.rig.gaze])
        self._rows = np.ascontiguousarray(shapes.reshape(len(shapes), -1), np.float32)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the (54,) weights: the expressions of the rig, then the eight ``eyeLook*`` directions."""
        return (*self.rig.names, *GAZE_NAMES)

    def frame(self, weights: _Weights = None, *, out: np.ndarray | None = None) -> np.ndarray:
        """Vertices (n, 3) float32 of the head, mm, model frame.

        Parameters
        ----------
        weights
            As for :meth:`toongeo.Rig.weights`: by name, (46,) or (54,).
        out : (n, 3) float32, contiguous, optional
            Is filled and returned; spares a stream an allocation a frame.

        Raises
        ------
        ValueError
            For weights as :meth:`toongeo.Rig.weights`; if ``out`` does not fit.
        """
        beta = self._limited(weights)
        if out is None:
            out = np.empty(self.rig.neutral.shape, np.float32)
        elif out.shape != self.rig.neutral.shape or out.dtype != np.float32 or not out.flags.carray:
            raise ValueError(
                f"out: expected contiguous writable float32 of shape {self.rig.neutral.shape},"
                f" got {out.dtype} {out.shape}"
            )
        flat = out.reshape(-1)
        np.copyto(flat, self._neutral)
        add_rows(flat, self._rows, beta)
        return out

    def normals(self, vertices: np.ndarray) -> np.ndarray:
        """Unit normals (n, 3) float64 of a frame (n, 3); they cost more than the frame."""
        return vertex_normals(vertices, self.faces)

    def eye_frames(self, weights: _Weights = None) -> tuple[np.ndarray, ...]:
        """Vertices (k, 3) float64, mm, of the left and of the right eyeball, if any; weights as for :meth:`frame`."""
        gaze = dict(zip(GAZE_NAMES, self._limited(weights)[len(self.rig.names) :].tolist(), strict=True))
        return tuple(self.eyes.looking(side, gaze) for side in range(len(self.eyes.templates)))

    def _limited(self, weights: _Weights) -> np.ndarray:
        beta = self.rig.weights(weights)
        return beta if self.limits is None else beta.clip(*self.limits)
