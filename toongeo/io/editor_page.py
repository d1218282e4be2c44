"""The page of the landmark editor, as one document."""

import html
import json
from collections.abc import Mapping
from string import Template
from typing import Any

from toongeo.io.page_html import PAGE, digest

__all__ = ["editor_page"]


def editor_page(settings: Mapping[str, Any], *, title: str) -> tuple[str, str]:
    """One HTML document with the editor and three.js in it, and its Content Security Policy.

    The policy lets only the script and the style run that are in it, and talk only to the server that it came from.

    Parameters
    ----------
    settings
        What `toongeo.app.editor` tells its page.
    title : str
        Any text; it is escaped.

    Examples
    --------
    >>> document, policy = editor_page({"name": "</script>"}, title="<b>")
    >>> "<title>&lt;b&gt;" in document, '"</script>"' in document, policy[:18]
    (True, False, "default-src 'none'")
    """
    script = (PAGE / "editor.js").read_text(encoding="utf-8")
    style = (PAGE / "editor.css").read_text(encoding="utf-8")
    document = Template((PAGE / "editor.html").read_text(encoding="utf-8")).substitute(
        title=html.escape(title),
        style=style,
        settings=json.dumps(settings).replace("<", "\\u003c"),
        script=script,
    )
    policy = (
        f"default-src 'none'; script-src {digest(script)}; style-src {digest(style)}; img-src blob: data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    return document, policy
