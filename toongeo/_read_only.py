"""Read-only arrays in frozen dataclasses."""

from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["read_only"]


def read_only(instance: object, *names: str) -> None:
    """Replace array fields of a frozen dataclass by views that cannot be written to; the given arrays stay writable.

    A field may be an array, a tuple of arrays, a mapping to arrays, or None.
    """
    for name in names:
        object.__setattr__(instance, name, _view(getattr(instance, name)))


def _view(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        view = value.view()
        view.setflags(write=False)
        return view
    if isinstance(value, tuple):
        return tuple(_view(part) for part in value)
    if isinstance(value, Mapping):
        return {key: _view(part) for key, part in value.items()}
    return value
