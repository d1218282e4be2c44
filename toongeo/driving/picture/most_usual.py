"""The state that a face returns to.

Constants were chosen as those of ``skin_samples``.
"""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats

__all__ = ["most_usual"]

_SHARE = 0.15  # of the frames, at rest; chosen on films of astronaut, bad_guy and blonde_girl_threequarter


def most_usual(weights: Floats) -> int:
    """Which frame shows a face as it is most of the time.

    A face comes back to rest from every expression, and to no other state as often: at rest the weights are nearest to
    those of many other frames. Their sum, which is least at rest in exact weights, is not in such as are read against a
    frame that is not quite at rest: errors of weights that nobody acts add up in it.

    Parameters
    ----------
    weights : (f, k)
        Of each frame; of any sign.

    Returns
    -------
    int
        The frame with the least mean distance to the 15 % of all that are most like it.

    Examples
    --------
    >>> most_usual(np.array([[0.9], [0.3], [0.31], [0.6], [0.32], [-0.4]]))
    2
    """
    apart = np.sort(np.linalg.norm(weights[:, None] - weights, axis=2), axis=1)
    alike = max(2, round(_SHARE * len(weights)))
    return int(apart[:, 1 : 1 + alike].sum(axis=1).argmin())
