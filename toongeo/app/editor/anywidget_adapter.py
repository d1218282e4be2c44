"""The optional package ``anywidget``, with which the editor and avatars are shown in notebooks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from toongeo._extras import missing_extra
from toongeo.io.page_html import PAGE

__all__ = ["notebook_widget"]


def notebook_widget(
    settings: Mapping[str, Any],
    heard: Callable[[Any, Any], None] | None = None,
    *,
    script: str = "editor.js",
    style: str | None = "editor.css",
    name: str = "LandmarkEditor",
) -> Any:
    """A widget that shows the editor, or what another script shows.

    Parameters
    ----------
    settings
        Of the page.
    heard
        Called with the widget and each message of the page.
    script, style
        Files of :mod:`toongeo.io.page`.
    name
        What needs the widget, for the error.

    Raises
    ------
    ImportError
        If ``anywidget`` is not installed; names the extra.
    """
    try:
        import anywidget
        import traitlets
    except ImportError as error:
        raise ImportError(missing_extra(name, "notebook")) from error

    class NotebookWidget(anywidget.AnyWidget):
        _esm = (PAGE / script).read_text(encoding="utf-8")
        _css = "" if style is None else (PAGE / style).read_text(encoding="utf-8")
        settings = traitlets.Dict().tag(sync=True)
        weights = traitlets.Dict().tag(sync=True)

    widget = NotebookWidget(settings=dict(settings))
    if heard is not None:
        widget.on_msg(lambda shown, message, buffers: heard(shown, message))
    return widget
