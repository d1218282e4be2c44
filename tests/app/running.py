"""A live avatar for tests."""

import asyncio
import threading
from contextlib import contextmanager

import pytest

from toongeo.app.live.avatar_server import AvatarServer
from toongeo.app.live.serve import run_server


@contextmanager
def running(glb, **options):
    """A server in a thread of its own."""
    server, ready, loop = AvatarServer(glb), threading.Event(), asyncio.new_event_loop()
    task = loop.create_task(run_server(server, lambda _: ready.set(), **options))

    def run():
        asyncio.set_event_loop(loop)
        with pytest.raises(asyncio.CancelledError):
            loop.run_until_complete(task)
        loop.close()

    thread = threading.Thread(target=run)
    thread.start()
    assert ready.wait(20)
    try:
        yield server
    finally:
        loop.call_soon_threadsafe(task.cancel)
        thread.join()
