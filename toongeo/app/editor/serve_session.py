"""A session in the browser until the user ends it."""

import contextlib
import webbrowser

from toongeo.app.editor.editor_server import EditorServer
from toongeo.app.editor.protocols import Session

__all__ = ["serve_session"]


def serve_session(session: Session, port: int, name: str, advice: str, *, show: bool) -> None:
    """Serve the page of a session on the loopback interface until Ctrl+C.

    Parameters
    ----------
    session : Session
    port : int
        0 takes a free one.
    name, advice : str
        Of the page, and how to go on; printed with its address once it is there.
    show : bool
        Open the page in a browser.

    Raises
    ------
    OSError, ValueError
        If the port is taken, or is none.
    """
    with EditorServer(session, port) as server, contextlib.suppress(KeyboardInterrupt):
        print(f"{name}: {server.url}\n{advice}", flush=True)
        if show:
            webbrowser.open(server.url)
        server.serve_forever()
