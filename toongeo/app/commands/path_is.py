"""Which of its files a command speaks of."""

from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["path_is"]

_PATH = "path:"


@contextmanager
def path_is(name: str) -> Iterator[None]:
    """What a function says of its ``path`` is said of this parameter of the command.

    Examples
    --------
    >>> with path_is("texture"):
    ...     raise ValueError("path: expected a picture")
    Traceback (most recent call last):
        ...
    ValueError: texture: expected a picture
    """
    try:
        yield
    except ValueError as error:
        text = str(error)
        if not text.startswith(_PATH):
            raise
        raise ValueError(f"{name}:{text.removeprefix(_PATH)}") from error
