"""A picture as a few thousand patches of one colour, and the graph of those that touch."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import dijkstra
from skimage.segmentation import slic

from toongeo.arrays import Singles

__all__ = ["LIGHTNESS", "Superpixels", "superpixels"]


LIGHTNESS = np.array([0.7, 1, 1], np.float32)  # weights of L, a, b in distances: shading changes L above all

_AREA = 37  # px of the view each
_COMPACT = 4.0
_PASSES = 6
_SMOOTH = (5, 6, 2)  # diameter px, CIELAB units and px of the bilateral filter before
_LEAST_STEP = 0.3  # CIELAB units between neighbours: a smooth way of many patches has a length too
_FARTHEST = 200.0  # CIELAB units; also what no seed reaches


@dataclass(frozen=True, eq=False)
class Superpixels:
    """Patches of a picture.

    Attributes
    ----------
    labels : (h, w) int
        Patch of each pixel, 0..k-1.
    lab : (h, w, 3) float32
        The picture in CIELAB.
    """

    labels: NDArray[np.intp]
    lab: Singles

    @cached_property
    def area(self) -> Singles:
        """Pixels (k,) of each."""
        return np.bincount(self.labels.ravel()).astype(np.float32)

    def mean(self, field: NDArray[np.generic]) -> Singles:
        """Mean (k,) over each patch of a field or mask (h, w)."""
        weights = np.asarray(field, np.float64).ravel()
        return (np.bincount(self.labels.ravel(), weights, len(self.area)) / self.area).astype(np.float32)

    @cached_property
    def colours(self) -> Singles:
        """Mean colours (k, 3)."""
        return np.stack([self.mean(self.lab[..., c]) for c in range(3)], axis=1)

    @cached_property
    def graph(self) -> csr_matrix:
        """Colour differences (k, k) of patches that touch."""
        a = np.concatenate([self.labels[:, :-1].ravel(), self.labels[:-1].ravel()])
        b = np.concatenate([self.labels[:, 1:].ravel(), self.labels[1:].ravel()])
        count = len(self.area)
        i, j = np.divmod(np.unique((np.minimum(a, b) * count + np.maximum(a, b))[a != b]), count)
        step = np.linalg.norm((self.colours[i] - self.colours[j]) * LIGHTNESS, axis=1)
        return coo_matrix((np.maximum(step, _LEAST_STEP), (i, j)), (count, count)).tocsr()

    def way(self, seeds: NDArray[np.bool_], power: float = 1) -> Singles:
        """Colour steps (k,) along the smoothest way from the nearest of some patches (k,) bool.

        They are summed; with a larger power the largest step counts most, as in the p-norm.
        """
        rows = np.flatnonzero(seeds)
        if len(rows) == 0:
            return np.full(len(self.area), _FARTHEST, np.float32)
        graph = self.graph if power == 1 else self.graph.power(power)
        found = dijkstra(graph, directed=False, indices=rows, min_only=True)
        return np.minimum(found ** (1 / power), _FARTHEST).astype(np.float32)


def superpixels(lab: Singles) -> Superpixels:
    """Patches of about 37 px (SLIC, Achanta et al. 2012) of a CIELAB picture (h, w, 3)."""
    smooth = cv2.bilateralFilter(lab, *_SMOOTH)
    labels = slic(
        smooth,
        n_segments=max(1, lab.shape[0] * lab.shape[1] // _AREA),
        compactness=_COMPACT,
        max_num_iter=_PASSES,
        convert2lab=False,
        start_label=0,
        channel_axis=2,
    )
    return Superpixels(np.unique(labels, return_inverse=True)[1].reshape(labels.shape), lab)
