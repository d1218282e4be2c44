"""The page that shows an avatar, as one document."""

import base64
import hashlib
import html
import json
from collections.abc import Mapping
from pathlib import Path
from string import Template

__all__ = ["PAGE", "digest", "page_html"]

PAGE = Path(__file__).parent / "page"


def page_html(
    glb: bytes,
    *,
    title: str,
    presets: Mapping[str, Mapping[str, float]] | None = None,
    live: str | None = None,
    framed: bool = False,
) -> str:
    """One HTML document with viewer, three.js and avatar in it, which asks nothing of a network.

    Its Content Security Policy lets only the scripts and styles run that are in it, and nothing be loaded.

    Parameters
    ----------
    glb : bytes
        A binary glTF file; its morph targets become sliders.
    title : str
        Any text; it is escaped.
    presets : name -> weights by name of target, optional
        Become buttons if the file has all their targets.
    live : str, optional
        Address of a WebSocket that weights come from, as of ``toongeo serve``.
    framed : bool
        The page stands in a frame, and exchanges weights with the page around it.

    Raises
    ------
    ValueError
        If the bytes are no binary glTF.

    Examples
    --------
    >>> document = page_html(b"glTF" + bytes(16), title='"><script>alert(1)</script>')
    >>> "<h1>&quot;&gt;&lt;script&gt;" in document, "<script>alert" in document
    (True, False)
    """
    if glb[:4] != b"glTF":
        raise ValueError(f"glb: expected the bytes of a .glb file, got {glb[:8]!r}")
    if not isinstance(title, str):
        raise ValueError(f"title: expected text, got {type(title).__name__}")
    title = title.encode("utf-8", "replace").decode()  # half a character, as of a name in another encoding
    script = (PAGE / "viewer.js").read_text(encoding="utf-8")
    style = (PAGE / "page.css").read_text(encoding="utf-8")
    settings = {"title": title, "presets": presets or {}, "live": live, "framed": framed}
    return Template((PAGE / "page.html").read_text(encoding="utf-8")).substitute(
        policy=html.escape(_content_policy(script, style, live)),
        title=html.escape(title),
        style=style,
        # A "<" in a name could end the element or begin a comment.
        settings=json.dumps(settings).replace("<", "\\u003c"),
        glb=base64.b64encode(glb).decode("ascii"),
        script=script,
    )


def _content_policy(script: str, style: str, live: str | None) -> str:
    """What the page may do: run this script and this style, read its own data, and talk to ``live``."""
    # A policy names a place without the query, where the token is.
    connections = " ".join(["blob:", "data:"] + ([live.partition("?")[0]] if live else []))
    return (
        f"default-src 'none'; script-src {digest(script)}; style-src {digest(style)}; img-src blob: data:; "
        f"connect-src {connections}; base-uri 'none'; form-action 'none'"
    )


def digest(text: str) -> str:
    """How a policy names a script or a style that may run."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode('ascii')}'"
