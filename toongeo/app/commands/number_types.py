"""Numbers on the command line, checked when they are parsed."""

import argparse
import math
from typing import Literal

__all__ = ["port", "sigma", "weight"]

_LAST_PORT = 65535


def port(text: str) -> int:
    """0 to 65535, where 0 takes a free one.

    Examples
    --------
    >>> port("8080")
    8080
    """
    if not (text.isascii() and text.isdigit() and int(text) <= _LAST_PORT):
        raise argparse.ArgumentTypeError(f"expected a port from 0 to {_LAST_PORT}, 0 for a free one, got {text!r}")
    return int(text)


def sigma(text: str) -> float | Literal["auto"]:
    """A number, or "auto"."""
    return "auto" if text == "auto" else _number(text, "'auto' or a number >= 0")


def weight(text: str) -> float:
    """A finite number."""
    return _number(text, "a number such as 0.5")


def _number(text: str, wanted: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"expected {wanted}, got {text!r}")
    return number
