"""Whether the fields of a dataclass hold what they say they hold."""

from __future__ import annotations

import types
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

__all__ = ["check_field_types"]


def check_field_types(instance: Any) -> None:
    """Refuse fields of another type than their annotations; protocols stand for any dataclass.

    Raises
    ------
    ValueError
        Names the field.

    Examples
    --------
    >>> from toongeo.metrics import MeshQuality
    >>> from toongeo.pipeline import RigReport
    >>> check_field_types(RigReport(seconds=1.0))
    >>> check_field_types(RigReport(seconds="long"))
    Traceback (most recent call last):
        ...
    ValueError: RigReport.seconds: expected float, got str
    """
    kind: Any = type(instance)
    hints = _hints(kind)
    for field in fields(instance):
        value, hint = getattr(instance, field.name), hints.get(field.name, Any)
        if not _fits(value, hint):
            expected = getattr(hint, "__name__", str(hint)) if get_origin(hint) is None else str(hint)
            raise ValueError(f"{type(instance).__name__}.{field.name}: expected {expected}, got {type(value).__name__}")


@cache
def _hints(kind: type) -> dict[str, Any]:
    try:
        return get_type_hints(kind)
    except NameError:  # names that only type checkers import
        return {}


def _fits(value: Any, hint: Any) -> bool:
    origin, parts = get_origin(hint), get_args(hint)
    if hint is Any:
        return True
    if origin in (Union, types.UnionType):
        return any(_fits(value, part) for part in parts)
    if origin is Literal:
        return value in parts
    if origin is tuple:
        return isinstance(value, tuple) and _fits_each(value, parts)
    if isinstance(origin, type) and issubclass(origin, Mapping | dict):
        return isinstance(value, Mapping) and all(_fits(part, parts[1]) for part in value.values())
    if origin is np.ndarray or hint is np.ndarray:
        return isinstance(value, np.ndarray) and value.dtype.kind in "biuf"
    return _is_a(value, hint)


def _fits_each(value: tuple[Any, ...], parts: tuple[Any, ...]) -> bool:
    if len(parts) == 2 and parts[1] is Ellipsis:
        return all(_fits(part, parts[0]) for part in value)
    return len(value) == len(parts) and all(map(_fits, value, parts))


def _is_a(value: Any, hint: Any) -> bool:
    if hint is None or hint is type(None):
        return value is None
    if hint is float:
        return isinstance(value, int | float | np.number) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int | np.integer) and not isinstance(value, bool)
    if getattr(hint, "_is_protocol", False):
        return hasattr(value, "__dataclass_fields__")
    return isinstance(value, hint) if isinstance(hint, type) else True
