"""Names of expressions as programs write them."""

from __future__ import annotations

import re

__all__ = ["expression_key"]

_SIDES = {"l": "left", "r": "right"}
# Before the name: Maya's deformer or a path, Character Creator's number (A25_Jaw_Open), and what says whose names.
_BEFORE = re.compile(r"(?:.*[.:|/])?(?:a\d\d_|arkit_|blendshapes?_)?")


def expression_key(name: str) -> str:
    """What is the same however an expression is written: small letters and digits, sides spelt out, no prefix.

    Examples
    --------
    >>> [expression_key(name) for name in ("JawOpen", "jaw_open", "blendShape1.jawOpen", "A25_Jaw_Open")]
    ['jawopen', 'jawopen', 'jawopen', 'jawopen']
    >>> expression_key("eyeBlink_L")
    'eyeblinkleft'
    """
    found = _BEFORE.match(name := name.lower())
    plain = name[found.end() :] if found else name
    plain = re.sub("_([lr])$", lambda side: _SIDES[side[1]], plain)
    return re.sub("[^a-z0-9]", "", plain)
