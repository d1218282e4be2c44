"""Bytes of a text file as text."""

from __future__ import annotations

import codecs

__all__ = ["decoded"]

_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)  # "Unicode" of Windows programs begins so


def decoded(content: bytes, errors: str = "strict") -> str:
    """UTF-8, or UTF-16 that says so by its first bytes; without its byte order mark.

    Raises
    ------
    UnicodeDecodeError
        If it is neither, and errors are strict.

    Examples
    --------
    >>> decoded("1 2".encode("utf-16")), decoded(b"\\xef\\xbb\\xbf1 2")
    ('1 2', '1 2')
    """
    return content.decode("utf-16" if content[:2] in _UTF16 else "utf-8-sig", errors)
