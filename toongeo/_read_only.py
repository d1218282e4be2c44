"""Read-only arrays in frozen dataclasses."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["read_only", "restored"]


def read_only(instance: object, *names: str) -> None:
    """Replace array fields of a frozen dataclass by views that cannot be written to; the given arrays stay writable.

    A field may be an array, a tuple of arrays, a mapping to arrays, or None.
    """
    for name in names:
        object.__setattr__(instance, name, _view(getattr(instance, name)))


def restored(instance: Any, state: Mapping[str, Any]) -> None:
    """The ``__setstate__`` of a dataclass whose arrays are read-only: copies and pickles of it are so as well."""
    for field in dataclasses.fields(instance):
        object.__setattr__(instance, field.name, state[field.name])
    instance.__post_init__()


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
