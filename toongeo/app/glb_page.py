"""A GLB file as a page."""

from pathlib import Path

from toongeo.avatar.save_avatar import page_presets
from toongeo.io import GlbDocument, page_html, read_glb

__all__ = ["glb_page", "read_avatar_glb", "target_names"]


def read_avatar_glb(path: Path) -> tuple[bytes, GlbDocument]:
    """The bytes of a GLB file, and what they hold.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is no GLB, is damaged, or has no morph targets.
    """
    document = read_glb(path)
    if not target_names(document):
        raise ValueError(f"{path}: expected an avatar, got a GLB without named morph targets")
    return path.read_bytes(), document


def target_names(document: GlbDocument) -> tuple[str, ...]:
    """Names of the morph targets of all meshes, each once."""
    meshes = document.json.get("meshes", [])
    return tuple(dict.fromkeys(name for mesh in meshes for name in mesh.get("extras", {}).get("targetNames", ())))


def glb_page(glb: bytes, title: str, *, live: str | None = None) -> str:
    """The page of a GLB file; presets become buttons. ``live`` as of :func:`toongeo.io.page_html`."""
    return page_html(glb, title=title, presets=page_presets(), live=live)
