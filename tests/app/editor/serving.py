"""A landmark editor for tests."""

import threading
from contextlib import contextmanager

from toongeo.app.editor.editor_server import EditorServer
from toongeo.app.editor.editor_session import EditorSession
from toongeo.app.editor.picture_list import PictureList


@contextmanager
def serving(path, detector=None, **options):
    """A server in a thread of its own."""
    with EditorServer(EditorSession(PictureList(path, **options), detector)) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()
