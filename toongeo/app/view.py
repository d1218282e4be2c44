"""``toongeo view``: an avatar in the browser, without a server."""

import tempfile
import webbrowser
from pathlib import Path

from toongeo.app.glb_page import glb_page, read_avatar_glb
from toongeo.io import atomic_write

__all__ = ["view"]


def view(avatar: Path, *, show: bool = True) -> Path:
    """Write the page of a GLB file into a new temporary folder and open it.

    Parameters
    ----------
    avatar : Path
    show : bool
        False only prints where the page is.

    Returns
    -------
    Path
        Of the page, which stays until the system clears its temporary files.

    Raises
    ------
    OSError, ValueError
        If the file cannot be read or is no avatar.
    """
    glb, _ = read_avatar_glb(avatar)
    page = Path(tempfile.mkdtemp(prefix="toongeo-")) / "avatar.html"
    atomic_write({page: glb_page(glb, avatar.stem).encode("utf-8")})
    print(page)
    if show:
        webbrowser.open(page.as_uri())
    return page
