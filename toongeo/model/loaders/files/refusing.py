"""One way of saying that a file is not what it should be."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

__all__ = ["refusing"]


@contextmanager
def refusing(path: Path, kind: str) -> Iterator[None]:
    """Turn whatever a damaged file makes of its reader into a ValueError that names the file.

    What bytes of unknown origin do to a parser (KeyError, struct.error, RecursionError, MemoryError ...) has no end;
    that the file is no ``kind`` is all that a caller needs to know. OSError passes, and ImportError of a missing extra.

    Raises
    ------
    ValueError

    Examples
    --------
    >>> with refusing(Path("face.bin"), "a model of eos"):
    ...     {}["shape"]
    Traceback (most recent call last):
    ...
    ValueError: face.bin: expected a model of eos, which cannot be read (KeyError: 'shape')
    """
    try:
        with np.errstate(all="ignore"):  # of numbers that are refused below
            yield
    except (OSError, ImportError):
        raise
    except Exception as error:
        text = str(error)
        if isinstance(error, ValueError) and text.startswith(str(path)):
            raise
        reason = f"{type(error).__name__}: {text}" if not isinstance(error, ValueError) else text
        raise ValueError(f"{path}: expected {kind}, which cannot be read ({reason[:300]})") from error
