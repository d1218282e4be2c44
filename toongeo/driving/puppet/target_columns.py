"""A take for the morph targets of any face."""

from __future__ import annotations

from collections.abc import Iterable

from toongeo.arrays import Floats
from toongeo.driving.table.expression_key import expression_key
from toongeo.driving.take import Take
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

__all__ = ["target_columns"]


def target_columns(take: Take, targets: Iterable[str]) -> dict[str, Floats]:
    """Weights (f,) over time of those targets that are expressions.

    Names are ours, ARKit's or Live Link Face's, in any of the ways of :func:`expression_key`. A target that both sides
    share gets their mean.

    Raises
    ------
    ValueError
        If no target is an expression.

    Examples
    --------
    >>> import numpy as np
    >>> take = Take.of_frames(np.eye(54)[10:12], 30)  # a blink of the left eye, and one of the right
    >>> {name: weights.tolist() for name, weights in target_columns(take, ["eyeBlink_L", "Hips"]).items()}
    {'eyeBlink_L': [1.0, 0.0]}
    """
    names = list(targets)
    known = {
        expression_key(name): own for scheme in ("live_link", "arkit") for name, own in SCHEMES[scheme].items() if own
    }
    known |= {expression_key(name): {name: 1.0} for name in EXPRESSIONS}
    columns = {}
    for name in names:
        plain = expression_key(name)
        if plain in known:
            columns[name] = take.weights[:, [EXPRESSIONS.index(own) for own in known[plain]]].mean(axis=1)
    if not columns:
        raise ValueError(f"targets: expected names of ARKit's expressions, got {', '.join(names[:5]) or 'none'}")
    return columns
