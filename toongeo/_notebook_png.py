"""How objects look as the last line of a notebook's cell."""

from importlib import import_module

__all__ = ["notebook_png"]


def notebook_png(instance: object) -> bytes | None:
    """The ``_repr_png_`` of a class that :mod:`toongeo.notebook` can draw; None where it cannot.

    What draws stands above all that is drawn, so it is looked up by its name when a notebook asks.
    """
    png: bytes | None = import_module("toongeo.notebook").png(instance)
    return png
