"""The optional package ``anywidget``, with which the editor is shown in notebooks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from toongeo._extras import missing_extra
from toongeo.io.page_html import PAGE

__all__ = ["notebook_widget"]


def notebook_widget(settings: Mapping[str, Any], heard: Callable[[Any, Any], None]) -> Any:
    """A widget that shows the editor.

    Parameters
    ----------
    settings
        Of the page.
    heard
        Called with the widget and each message of the page.

    Raises
    ------
    ImportError
        If ``anywidget`` is not installed; names the extra.
    """
    try:
        import anywidget
        import traitlets
    except ImportError as error:
        raise ImportError(missing_extra("LandmarkEditor", "notebook")) from error

    class EditorWidget(anywidget.AnyWidget):
        _esm = (PAGE / "editor.js").read_text(encoding="utf-8")
        _css = (PAGE / "editor.css").read_text(encoding="utf-8")
        settings = traitlets.Dict().tag(sync=True)

    widget = EditorWidget(settings=dict(settings))
    widget.on_msg(lambda shown, message, buffers: heard(shown, message))
    return widget
