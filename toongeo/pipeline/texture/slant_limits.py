"""How squarely a place on the face must be seen for the picture to be believed there.

Constants were chosen on manga_girl and caricatures 1, 21, 34 and 47, with bad_guy in sight.
"""

import numpy as np

from toongeo.arrays import Reals
from toongeo.model import MorphableModel

__all__ = ["slant_limits"]

# Cosines to the viewer between which belief grows from 0 to 1, amid the face and on its sides. Drawings are dark along
# the outline of a cheek: with the first pair that was streaks on the sides of heads. Lips and chin are steep, too, but
# there the mirrored side would be drawn instead, a cigarette twice.
_AMID, _SIDES = (0.15, 0.45), (0.3, 0.65)


def slant_limits(model: MorphableModel) -> tuple[Reals, Reals]:
    """Lower and upper limit (n,) of the cosine; those of the sides from the outer eye corners outwards."""
    outwards = np.abs(model.mean[:, 0])
    mouth, eyes = (outwards[model.landmarks[rows]].mean() for rows in ([48, 54], [36, 45]))
    share = np.clip((outwards - mouth) / max(float(eyes - mouth), 1e-6), 0, 1)
    low, high = ((1 - share) * amid + share * side for amid, side in zip(_AMID, _SIDES, strict=True))
    return low, high
