"""``toongeo serve``: an avatar that moves while weights come."""

import asyncio
import contextlib
import itertools
import webbrowser
from collections.abc import Callable
from pathlib import Path

import numpy as np

from toongeo.app.live.avatar_server import AvatarServer
from toongeo.app.read_take import read_take
from toongeo.driving import Take
from toongeo.model.expression_schemes import EXPRESSIONS

__all__ = ["serve"]

_FPS = 60.0


def serve(avatar: Path, *, weights: Path | None = None, port: int = 0, loop: bool = False, show: bool = True) -> None:
    """Serve the page of an avatar on the loopback interface until interrupted.

    Parameters
    ----------
    avatar : Path
        A GLB file.
    weights : Path, optional
        A take that is played to the page.
    port : int
        0 takes a free one.
    loop : bool
        Play the take again and again.
    show : bool
        Open the page in a browser; its address is printed anyway.

    Raises
    ------
    ImportError
        If ``websockets`` is not installed.
    OSError, ValueError
        If a file cannot be read or is not what it should be, or the port is taken.
    """
    take = None if weights is None else read_take(weights).resampled(_FPS)
    server = AvatarServer(avatar, port)

    def started(server: AvatarServer) -> None:
        print(f"page:    {server.url}\nsources: {server.source_url}\nCtrl+C ends", flush=True)
        if show:
            webbrowser.open(server.url)

    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(run_server(server, started, take, loop))


async def run_server(
    server: AvatarServer, started: Callable[[AvatarServer], None], take: Take | None = None, loop: bool = False
) -> None:
    """Start a server, say so, play a take if there is one, and go on until cancelled."""
    async with server:
        started(server)
        if take is not None:
            await _play(server, take, loop)
        await asyncio.get_running_loop().create_future()


async def _play(server: AvatarServer, take: Take, loop: bool) -> None:
    """A take at its own speed, from when the first page is there."""
    frames = [
        {name: float(weight) for name, weight in zip(EXPRESSIONS, row, strict=True) if name in server.names}
        for row in np.asarray(take.weights)
    ]
    await server.first_page()
    clock = asyncio.get_running_loop()
    begin = clock.time()
    for count, frame in enumerate(itertools.cycle(frames) if loop else frames):
        await asyncio.sleep(max(0.0, begin + count / _FPS - clock.time()))
        server.show(frame)
