"""One place that turns the surprises of readers into what is promised of them."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import ParamSpec, TypeVar

import numpy as np

from toongeo.reading.check_file import check_kind

__all__ = ["promise", "promised"]

_P = ParamSpec("_P")
_R = TypeVar("_R")
_NAMED = re.compile(r"[a-z_0-9]+(, [a-z_0-9]+)*: ")  # how messages of this library begin: with an argument
_LONGEST = 200  # characters of a library's own words


@contextmanager
def promise(path: object, expected: str, argument: str = "path", *, alone: bool = False) -> Iterator[None]:
    """Whatever fails inside becomes a ``ValueError`` or an ``OSError`` that names the argument and the cause.

    Libraries fail on damaged files in ways that nobody lists (``BadZipFile``, ``EOFError``, ``KeyError``,
    ``RecursionError``, ``struct.error``, ``zlib.error`` ...). The promise is about errors; that memory and time are
    bounded is for who reads: see :func:`toongeo.reading.check_file.check_file`.

    Parameters
    ----------
    path
        The file, for the message.
    expected
        What it should be, with its article: ``"a GLB"``.
    argument
        What the caller calls it.
    alone
        Whether nothing but the file can be at fault: then errors that name something else are about it, too.

    Raises
    ------
    OSError
        If the system refused something; it names the file.
    ValueError
        If anything else failed. Those that name an argument or the file already pass unchanged. What numbers of a
        damaged file do to NumPy on the way there warns of nothing.
    ImportError
        If a package is missing, which is no fault of the file.

    Examples
    --------
    >>> with promise("face.xyz", "a list of points"):
    ...     {}["points"]
    Traceback (most recent call last):
        ...
    ValueError: path: expected a list of points, but face.xyz is damaged or none (KeyError: 'points')
    """
    try:
        with np.errstate(all="ignore"):
            yield
    except (ImportError, Warning):
        raise
    except OSError as error:
        if error.errno is None:  # of a decoder, not of the system
            raise ValueError(_message(path, expected, argument, error)) from error
        if error.filename is None and str(path) not in str(error):
            raise OSError(error.errno, f"cannot read {path}: {error.strerror}") from error
        raise
    except MemoryError as error:
        raise ValueError(f"{argument}: expected {expected} that fits into memory, but {path} does not") from error
    except Exception as error:
        text = str(error)
        named = text.startswith(f"{argument}: ") if alone else _NAMED.match(text)
        if isinstance(error, ValueError) and (named or str(path) in text):
            raise
        raise ValueError(_message(path, expected, argument, error)) from error


def promised(expected: str, argument: str = "path") -> Callable[[Callable[_P, _R]], Callable[_P, _R]]:
    """:func:`promise` about a whole reader, whose first parameter is the path; neither of a device nor of a pipe.

    Examples
    --------
    >>> @promised("a number")
    ... def read_number(path):
    ...     return float(open(path).read())
    >>> read_number(3.5)
    Traceback (most recent call last):
        ...
    ValueError: path: expected the name of a file, got float
    """

    def decorate(read: Callable[_P, _R]) -> Callable[_P, _R]:
        @wraps(read)
        def guarded(*args: _P.args, **kwargs: _P.kwargs) -> _R:
            path = args[0] if args else kwargs.get(argument)
            if args or argument in kwargs:
                _check_name(path, argument)
                check_kind(path, argument)  # type: ignore[arg-type]
            with promise(path, expected, argument):
                return read(*args, **kwargs)

        return guarded

    return decorate


def _check_name(path: object, argument: str) -> None:
    if not isinstance(path, str | os.PathLike):
        raise ValueError(f"{argument}: expected the name of a file, got {type(path).__name__}")
    if "\0" in os.fspath(path):
        raise ValueError(f"{argument}: expected the name of a file, got one with a zero byte: {path!r}")


def _message(path: object, expected: str, argument: str, error: Exception) -> str:
    reason = f"{type(error).__name__}: {error}"[:_LONGEST]
    return f"{argument}: expected {expected}, but {path} is damaged or none ({reason})"
