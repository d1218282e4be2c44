"""How dataclasses that hold arrays print."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["brief_repr"]

_FEW = 4  # numbers or parts that are shown one by one
_LONG = 60  # characters


def brief_repr(instance: Any) -> str:
    """The ``__repr__`` of a dataclass in a line or two: arrays by kind and shape, parts by their class.

    Examples
    --------
    >>> @dataclasses.dataclass
    ... class Part:
    ...     points: np.ndarray
    ...     name: str = "nose"
    ...     __repr__ = brief_repr
    >>> Part(np.zeros((68, 2)))
    Part(points=<float64 (68, 2)>, name='nose')
    """
    fields = ", ".join(f"{f.name}={_brief(getattr(instance, f.name))}" for f in dataclasses.fields(instance) if f.repr)
    return f"{type(instance).__name__}({fields})"


def _brief(value: Any) -> str:
    if isinstance(value, np.ndarray):
        if 0 < value.size <= _FEW:
            return repr(value.tolist())
        return f"<{value.dtype} {value.shape}>"
    if dataclasses.is_dataclass(value):
        return f"<{type(value).__name__}>"
    if isinstance(value, (tuple, list)):
        kind = "tuple" if isinstance(value, tuple) else "list"
        return f"({', '.join(map(_brief, value))})" if len(value) <= _FEW else f"<{kind} of {len(value)}>"
    if isinstance(value, Mapping):
        return f"<{type(value).__name__} of {len(value)}>"
    text = repr(value)
    return text if len(text) <= _LONG else f"<{type(value).__name__}>"
