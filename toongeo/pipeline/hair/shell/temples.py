"""Skin that hair covers on the sides of a head, seen along them from the front."""

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Mask
from toongeo.model import MorphableModel

__all__ = ["beside_hair", "behind_temples"]

# Share of the way from the front of the ears to the outer corners of the eyes at which hair begins on a temple: on the
# sides of heads in profile it stands a third to a half before the ear. Chosen on astronaut, bad_guy, blue_girl,
# manga_girl and caricatures 1 and 47.
_TEMPLE = 0.4
_OUTER_CORNERS = (36, 45)


def behind_temples(model: MorphableModel) -> NDArray[np.bool_]:
    """Vertices (n,) on the sides of the head, behind the line where hair begins on the temples, on the mean face.

    The sides lie beyond the outer corners of the eyes: neither sockets nor the front of the neck are among them.
    """
    mean, ears = model.mean, model.mean[model.region("ears")]
    corners = mean[model.landmarks[list(_OUTER_CORNERS)]]
    line = ears[:, 2].max() + _TEMPLE * (corners[:, 2].mean() - ears[:, 2].max())
    beyond = np.abs(mean[:, 0]) > np.abs(corners[:, 0]).min()
    return np.asarray(model.region("skin") & beyond & (mean[:, 2] < line))


def beside_hair(hair: Mask, skin: Mask, ears: Mask, middle: int) -> Mask:
    """Cells of ``skin`` that hair on the same row borders outwards, with nothing but such skin and hair between.

    On the steep side of a head a sliver of skin between face and hair would reach back to where the head turns from
    front to back: a bay in the hair, or spikes where strands and skin take turns. Ears that are seen end the search.

    Parameters
    ----------
    hair : (rows, columns) bool
    skin : (rows, columns) bool
        Behind the line of the temples.
    ears : (rows, columns) bool
        Seen.
    middle : int
        Column of the face's middle, where both sides end.
    """
    found = np.zeros_like(hair)
    for columns in (range(middle), range(hair.shape[1] - 1, middle - 1, -1)):
        reached = np.zeros(len(hair), bool)
        for column in columns:
            reached = hair[:, column] | (reached & skin[:, column] & ~ears[:, column])
            found[:, column] = reached & ~hair[:, column]
    return found
