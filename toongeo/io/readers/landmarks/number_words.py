"""Numbers in text, exactly."""

import math
import re
from decimal import Context, Decimal

__all__ = ["EXACT", "number", "words"]

# Enough digits that adding or subtracting 1 never rounds: 1.1 - 1 is 0.1, and a file reads back bit for bit.
EXACT = Context(prec=1100)
_LONGEST = 1200

# How programs write a number that is none: C, .NET, the C library of Windows, R, pandas and JSON.
_MISSING = frozenset(
    (
        "nan",
        "+nan",
        "-nan",
        "na",
        "n/a",
        "<na>",
        "null",
        "none",
        "1.#qnan",
        "1.#ind",
        "-1.#ind",
        "1.#qnan0",
        "-1.#ind00",
    )
)
_BRACKETS = str.maketrans('()[]"', "     ")
# One comma between digits in each word, as in 37,94 236,1 or 37,94;236,1: then it stands before decimals.
_DECIMAL_COMMAS = re.compile(r"[+-]?\d+(?:,\d+)?(?:e[+-]?\d+)?", re.IGNORECASE)


def number(word: str, shift: int = 0) -> float | None:
    """The number that a word is, less ``shift``; NaN for one that means a missing value, None for any other.

    >>> number("1.1", 1), number("NaN"), number("x")
    (0.1, nan, None)
    """
    if word.lower() in _MISSING:
        return float("nan")
    if len(word) > _LONGEST:
        return None
    try:
        plain = float(word)
        return float(EXACT.subtract(Decimal(word), shift)) if shift and math.isfinite(plain) else plain
    except (ArithmeticError, ValueError):
        return None


def words(line: str) -> list[str]:
    """Words of a line between blanks, commas, semicolons or brackets; empty cells alone are missing values."""
    line = _with_points(line.replace("(ind)", ""))  # -nan(ind) is one of the C library's
    cells = line.replace(";", ",").split(",")
    if len(cells) > 1 and not any(map(str.strip, cells)):
        return ["nan"] * len(cells)
    return " ".join(cells).translate(_BRACKETS).split()


def _with_points(line: str) -> str:
    """A line with points before decimals, if commas stand there: in a row of two to four numbers."""
    if "," not in line or "." in line:
        return line
    parts = line.replace(";", " ").split()
    decimal = len(parts) in (2, 3, 4) and all(map(_DECIMAL_COMMAS.fullmatch, parts))
    return line.replace(",", ".") if decimal else line
