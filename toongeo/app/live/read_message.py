"""What a source sends to a live avatar."""

import json
from collections.abc import Sequence

from toongeo.pipeline.rig.weight_vector import weight_vector

__all__ = ["read_message"]


def read_message(message: str | bytes, names: Sequence[str]) -> dict[str, float]:
    """Weights by name out of JSON: ``{"jawOpen": 0.5}``, or an array of all of them in the order of ``names``.

    Names that an object leaves out stay as they are.

    Raises
    ------
    ValueError
        If it is neither, a name is unknown, or a weight is not a finite number.

    Examples
    --------
    >>> read_message("[0, 0.5]", ["eyeBlinkLeft", "jawOpen"])
    {'eyeBlinkLeft': 0.0, 'jawOpen': 0.5}
    """
    try:
        content = json.loads(message)
    except (ValueError, RecursionError):  # also of numbers with thousands of digits
        raise ValueError("message: expected JSON") from None
    if isinstance(content, dict):
        vector = weight_vector(content, names)
        return {name: float(vector[names.index(name)]) for name in content}
    if not (isinstance(content, list) and all(type(value) in (int, float) for value in content)):
        raise ValueError("message: expected an object of weights, or an array of numbers")
    return dict(zip(names, weight_vector(content, names).tolist(), strict=True))
