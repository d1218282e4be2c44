"""Spheres for the eyeballs of the mean face and how they move and grow with the identity modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from cage import Cage
from source import Floats

from toongeo.geometry.catmull_clark import catmull_clark


@dataclass(frozen=True, eq=False)
class Eyes:
    """Left and right: `centre` (2, 3) mm, `radius` (2,), `centre_modes` (2, k, 3), `radius_modes` (2, k)."""

    centre: Floats
    radius: Floats
    centre_modes: Floats
    radius_modes: Floats


def fitted_eyes(cage: Cage, mean: Floats, modes: Floats) -> Eyes:
    """Least-squares spheres of the refined helper eyeballs; `mean` (n, 3) and `modes` (k, n, 3) at the cage,
    mm."""
    centres, radii, centre_modes, radius_modes = [], [], [], []
    for side in ("left", "right"):
        ids = cage.vertices_of(f"eye_{side}")
        local = np.searchsorted(ids, cage.quads[f"eye_{side}"])
        ball = catmull_clark(local, len(ids))[0] @ mean[ids]
        # |p|^2 = 2 c.p + (r^2 - |c|^2) is linear in c and the last term.
        solution = np.linalg.lstsq(np.column_stack([2 * ball, np.ones(len(ball))]), (ball**2).sum(1))[0]
        centre = solution[:3]
        radius = np.sqrt(solution[3] + centre @ centre)
        away = mean[ids] - mean[ids].mean(0)
        shift = modes[:, ids].mean(1)
        growth = np.einsum("knc,nc->k", modes[:, ids] - shift[:, None], away) / (away**2).sum()
        centres.append(centre)
        radii.append(radius)
        centre_modes.append(shift)
        radius_modes.append(radius * growth)
    return _symmetric(Eyes(np.array(centres), np.array(radii), np.array(centre_modes), np.array(radius_modes)))


def _symmetric(eyes: Eyes) -> Eyes:
    """Exact mirror symmetry of the mean; the modes keep theirs, symmetric or antisymmetric, to rounding."""
    centre = (eyes.centre + eyes.centre[::-1] * [-1, 1, 1]) / 2
    return Eyes(centre, np.full(2, eyes.radius.mean()), eyes.centre_modes, eyes.radius_modes)
