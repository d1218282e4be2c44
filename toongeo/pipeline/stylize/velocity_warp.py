"""Warps of a picture that cannot fold: exponentials of stationary velocity fields."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo.arrays import Floats, Singles
from toongeo.pipeline.stylize.appearance.pixels import sampled
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.style_rules import WarpRule

__all__ = ["VelocityWarp", "velocity_warp"]

_CELL = 1 / 56  # of the grid, face sizes: an eye's height has five cells
_DOMAIN = 3.2  # half the side of what may move, face sizes: head, hair and shoulders
_BEYOND = 0.5  # how far beyond the picture's border the field goes on, face sizes
_FADE = 0.3  # over which it comes to rest at the domain's border, face sizes
# Largest Frobenius norm of the field's gradient. Determinants stay above exp(-2 * 2.2), which the grid resolves;
# without it 2 of 300 random faces folded.
_STEEPEST = 2.2
_STEPS = 10  # of Runge-Kutta for a gradient of 1: there and back within a twentieth of a pixel at 1024 px
# Radii (face sizes) and weights of the Gaussians by which displacements of landmarks spread, and their ridge:
# features move by themselves, the head as a whole.
_SPREAD = ((0.16, 0.25), (0.55, 0.75))
_RIDGE = 0.02
_COARSER = 4
_SPARSE = 2  # a picture's warp is interpolated between every second node: it is off by less than 0.02 px


@dataclass(frozen=True, eq=False)
class VelocityWarp:
    """The flow of a velocity field v over one unit of time, exp(v); its inverse is exp(-v) (Arsigny et al. 2006).

    Attributes
    ----------
    field : (h, w, 2) float32, px
        Velocities at the nodes of a grid; nothing moves outside it.
    corner : (2,) float, px
        Its first node.
    cell : float, px
        Distance of nodes.
    steps : int
        Of Runge-Kutta.
    """

    field: Singles
    corner: Floats
    cell: float
    steps: int

    __repr__ = brief_repr

    def points(self, points: Floats) -> Floats:
        """Where points (..., 2) px of the picture go."""
        return self._flow(points, 1.0)

    def inverse(self, points: Floats) -> Floats:
        """Where points (..., 2) px of the result come from."""
        return self._flow(points, -1.0)

    def sources(self, shape: tuple[int, int]) -> Singles:
        """Where each pixel of the result (h, w, 2) comes from, px."""
        nodes = self._nodes()[::_SPARSE, ::_SPARSE]
        moved = np.asarray(self.inverse(nodes) - nodes, np.float32)
        cell = self.cell * _SPARSE
        rows, columns = np.mgrid[: shape[0], : shape[1]].astype(np.float32)
        grid = cv2.merge([columns, rows])
        # pixel (column, row) is node (pixel - corner) / cell
        to_node = np.array([[1 / cell, 0, -self.corner[0] / cell], [0, 1 / cell, -self.corner[1] / cell]])
        flags = cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP
        came = cv2.warpAffine(moved, to_node, shape[::-1], flags=flags, borderMode=cv2.BORDER_CONSTANT)
        return np.asarray(cv2.add(came, grid))

    def picture(self, img: np.ndarray, sources: Singles | None = None) -> np.ndarray:
        """A picture (h, w[, c]) of any depth after the warp; ``sources`` if they are known already."""
        sources = self.sources((img.shape[0], img.shape[1])) if sources is None else sources
        return np.asarray(sampled(img, sources, cv2.INTER_CUBIC, cv2.BORDER_REPLICATE))

    def determinants(self) -> Floats:
        """Jacobian determinants (h - 2, w - 2) of the inverse at inner nodes of the grid, by central differences."""
        came = self.inverse(self._nodes())
        across, down = (came[1:-1, 2:] - came[1:-1, :-2]), (came[2:, 1:-1] - came[:-2, 1:-1])
        determinants = across[..., 0] * down[..., 1] - across[..., 1] * down[..., 0]
        return np.asarray(determinants / (2 * self.cell) ** 2)

    def scaled(self, factor: float) -> "VelocityWarp":
        """The same warp of a resized picture; pixel centres are integers in both."""
        return replace(
            self,
            field=self.field * np.float32(factor),
            corner=(self.corner + 0.5) * factor - 0.5,
            cell=self.cell * factor,
        )

    def _nodes(self) -> Floats:
        rows, columns = np.mgrid[: self.field.shape[0], : self.field.shape[1]]
        return np.asarray(self.corner + self.cell * np.stack([columns, rows], axis=-1))

    def _flow(self, points: Floats, sign: float) -> Floats:
        points = np.asarray(points, np.float64)
        at = points.reshape(-1, 1, 2)
        step = sign / self.steps
        for _ in range(self.steps):
            first = self._velocity(at)
            second = self._velocity(at + step / 2 * first)
            third = self._velocity(at + step / 2 * second)
            fourth = self._velocity(at + step * third)
            at = at + step / 6 * (first + 2 * second + 2 * third + fourth)
        return np.asarray(at.reshape(points.shape))

    def _velocity(self, at: Floats) -> Singles:
        nodes = np.asarray((at - self.corner) / self.cell, np.float32)
        # remap takes pictures of less than 32,768 rows
        parts = [
            sampled(self.field, part, cv2.INTER_LINEAR, cv2.BORDER_CONSTANT)
            for part in np.array_split(nodes, max(1, -(-len(nodes) // 30_000)))
        ]
        return np.concatenate(parts)


def velocity_warp(
    shape: tuple[int, int],
    landmarks: Floats,
    rules: Sequence[WarpRule],
    strength: float = 1.0,
    displacement: Floats | None = None,
) -> VelocityWarp:
    """The warp of a picture (h, w) whose face has landmarks (68, 2) px, by rules and by displacements of landmarks.

    Parameters
    ----------
    shape : (h, w)
    landmarks : (68, 2) float, px
    rules : sequence of WarpRule
    strength : float
        Times the field; 0 moves nothing.
    displacement : (68, 2) float, px, optional
        Velocities at the landmarks, spread by Gaussians of two radii.
    """
    frame = face_frame(landmarks)
    low = np.maximum(frame.origin - _DOMAIN * frame.size, -_BEYOND * frame.size)
    high = np.minimum(frame.origin + _DOMAIN * frame.size, np.array(shape[::-1]) + _BEYOND * frame.size)
    cell = _CELL * frame.size
    width, height = np.ceil((high - low) / cell).astype(int) + 1
    rows, columns = np.mgrid[:height, :width]
    at = frame.to_frame(low + cell * np.stack([columns, rows], axis=-1))
    points = frame.to_frame(landmarks)
    field = np.zeros_like(at)
    for rule in rules:
        field += strength * rule.velocity(at, points)
    if displacement is not None:
        field += _spread(at, points, strength * displacement @ frame.axes.T / frame.size)
    border = np.minimum(
        np.minimum(rows, height - 1 - rows), np.minimum(columns, width - 1 - columns)
    )  # nodes from the border of the domain
    field *= np.clip(border * _CELL / _FADE, 0, 1)[..., None]
    steep = _steepest(field)
    field *= min(1.0, _STEEPEST / max(steep, 1e-9))
    steps = max(4, int(np.ceil(_STEPS * min(steep, _STEEPEST))))
    return VelocityWarp(np.asarray(frame.size * field @ frame.axes, np.float32), low, cell, steps)


def _steepest(field: Floats) -> float:
    """Largest Frobenius norm of the gradient, in face sizes."""
    down, across = np.gradient(field, _CELL, axis=(0, 1))
    return float(np.sqrt((across**2 + down**2).sum(axis=-1).max()))


def _spread(at: Floats, points: Floats, displacement: Floats) -> Floats:
    """Displacements of landmarks (68, 2) interpolated at points (h, w, 2) of the frame."""

    def kernel(a: Floats, b: Floats) -> Floats:
        square = np.square(a[:, None] - b[None]).sum(axis=-1)
        return np.asarray(sum(weight * np.exp(-square / (2 * radius**2)) for radius, weight in _SPREAD))

    weights = np.linalg.solve(kernel(points, points) + _RIDGE * np.eye(len(points)), displacement)
    # The narrower Gaussian spans nine cells, so every fourth node knows it all.
    coarse = at[::_COARSER, ::_COARSER]
    known = (kernel(coarse.reshape(-1, 2), points) @ weights).reshape(coarse.shape).astype(np.float32)
    rows, columns = np.mgrid[: at.shape[0], : at.shape[1]].astype(np.float32) / _COARSER
    nodes = np.stack([columns, rows], axis=-1)
    return np.asarray(sampled(known, nodes, cv2.INTER_CUBIC, cv2.BORDER_REPLICATE), np.float64)
