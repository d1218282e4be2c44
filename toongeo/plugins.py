"""Parts that installed packages offer by name."""

from __future__ import annotations

import inspect
from importlib.metadata import entry_points
from typing import Any

__all__ = ["GROUP", "plugin", "plugin_names"]

GROUP = "toongeo.plugins"


def plugin_names(kind: str) -> list[str]:
    """Names of what is installed of a kind, such as ``"detector"``.

    Parameters
    ----------
    kind : str
        The word before the dot of what packages offer.

    Returns
    -------
    list of str
        Sorted.

    Examples
    --------
    >>> plugin_names("beard")
    []
    """
    return sorted({entry.name.partition(".")[2] for entry in _entries(kind)})


def plugin(part: Any, kind: str) -> Any:
    """What a name stands for; everything else is given back as it is.

    A package offers a part in its ``pyproject.toml``::

        [project.entry-points."toongeo.plugins"]
        "detector.mine" = "my_package:MyDetector"

    and ``detect_landmarks(img, detector="mine")`` calls it. What stands there may be the part itself, or a class or
    function without arguments that makes it. A package is imported when its part is asked for, never before.

    Parameters
    ----------
    part : str, or anything
    kind : str
        ``"detector"``, ``"parser"``, ``"regressor"`` ...: the word before the dot.

    Returns
    -------
    The part, or ``part`` itself unless it is a name.

    Raises
    ------
    ValueError
        If no installed package offers it; names those that are there.

    Examples
    --------
    >>> plugin(len, "detector")
    <built-in function len>
    >>> plugin("mine", "detector")
    Traceback (most recent call last):
    ...
    ValueError: detector: expected one of the installed ones (there are none), got 'mine'
    """
    if not isinstance(part, str):
        return part
    found = [entry for entry in _entries(kind) if entry.name == f"{kind}.{part}"]
    if not found:
        known = ", ".join(plugin_names(kind)) or "there are none"
        raise ValueError(f"{kind}: expected one of the installed ones ({known}), got {part!r}")
    loaded = found[0].load()
    return loaded() if _is_maker(loaded) else loaded


def _entries(kind: str) -> list[Any]:
    entries = entry_points(group=GROUP)
    return sorted((entry for entry in entries if entry.name.startswith(f"{kind}.")), key=lambda entry: entry.value)


def _is_maker(loaded: Any) -> bool:
    """Whether it makes the part rather than being it: a class, or a function that needs nothing."""
    if inspect.isclass(loaded):
        return True
    if not inspect.isfunction(loaded):
        return False
    parameters = inspect.signature(loaded).parameters.values()
    return not any(part.kind not in (part.VAR_POSITIONAL, part.VAR_KEYWORD) for part in parameters)
