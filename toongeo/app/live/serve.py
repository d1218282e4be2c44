"""``toongeo serve``: an avatar that moves while weights come, or as a face before a camera does."""

import asyncio
import contextlib
import itertools
import webbrowser
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from toongeo.app.commands.path_is import path_is
from toongeo.app.live.avatar_server import AvatarServer
from toongeo.app.read_take import read_take
from toongeo.arrays import Bytes, Floats
from toongeo.driving import LiveVideo, Take
from toongeo.io import open_camera
from toongeo.model.expression_schemes import EXPRESSIONS

__all__ = ["serve"]

_FPS = 60.0
_Frames = Iterable[tuple[Bytes, float]]  # with their times, s


def serve(
    avatar: Path,
    *,
    weights: Path | None = None,
    camera: str | None = None,
    port: int = 0,
    loop: bool = False,
    show: bool = True,
) -> None:
    """Serve the page of an avatar on the loopback interface until interrupted.

    Parameters
    ----------
    avatar : Path
        A GLB file.
    weights : Path, optional
        A take that is played to the page.
    camera : str, optional
        The face before a camera of this number, or in a film, is shown: see :func:`toongeo.io.open_camera`.
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
        If a file cannot be read or is not what it should be, there is no such camera, or the port is taken.
    """
    with path_is("weights"):
        take = None if weights is None else read_take(weights).resampled(_FPS)
    seen = None if camera is None else open_camera(camera)
    server = AvatarServer(avatar, port)

    def started(server: AvatarServer) -> None:
        print(f"page:    {server.url}\nsources: {server.source_url}\nCtrl+C ends", flush=True)
        if show:
            webbrowser.open(server.url)

    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(run_server(server, started, take, loop, seen))


async def run_server(
    server: AvatarServer,
    started: Callable[[AvatarServer], None],
    take: Take | None = None,
    loop: bool = False,
    camera: _Frames | None = None,
) -> None:
    """Start a server, say so, play a take or show a camera's face if there is one, and go on until cancelled."""
    async with server:
        started(server)
        if take is not None:
            await _play(server, take, loop)
        if camera is not None:
            await _mirror(server, camera)
        await asyncio.get_running_loop().create_future()


async def _play(server: AvatarServer, take: Take, loop: bool) -> None:
    """A take at its own speed, from when the first page is there."""
    frames = [_named(server, row) for row in np.asarray(take.weights)]
    await server.first_page()
    clock = asyncio.get_running_loop()
    begin = clock.time()
    for count, frame in enumerate(itertools.cycle(frames) if loop else frames):
        await asyncio.sleep(max(0.0, begin + count / _FPS - clock.time()))
        server.show(frame)


async def _mirror(server: AvatarServer, camera: _Frames) -> None:
    """What a camera sees from when the first page is there; frames are looked at in a thread beside the server."""
    live = LiveVideo()
    await server.first_page()
    print("look into the camera without expression", flush=True)
    frames, is_ready = iter(camera), False
    while (seen := await asyncio.to_thread(next, frames, None)) is not None:
        weights = await asyncio.to_thread(live, *seen)
        if live.is_ready and not is_ready:
            print("the face is known: go on", flush=True)
        is_ready = live.is_ready
        server.show(_named(server, weights))
    print("no more frames come from the camera", flush=True)


def _named(server: AvatarServer, weights: Floats) -> dict[str, float]:
    """Weights (54,) by the names that the avatar has."""
    return {name: float(weight) for name, weight in zip(EXPRESSIONS, weights, strict=True) if name in server.names}
