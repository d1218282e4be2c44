"""A page with an avatar that takes weights while they come, on this computer only."""

from __future__ import annotations

import asyncio
import contextlib
import json
import secrets
from http import HTTPStatus
from pathlib import Path
from typing import Any

from toongeo.app.glb_page import glb_page, read_avatar_glb, target_names
from toongeo.app.live.read_message import read_message
from toongeo.app.loopback import HOST, check_port, path_and_token, refusal
from toongeo.driving.websockets_adapter import load_websockets

__all__ = ["AvatarServer", "LARGEST", "PAGE", "acknowledged"]

LARGEST = 16_384  # bytes of a message; 54 weights with their names take 2,000
_MOST_PEERS = 32  # pages and sources together
_MOST_WAITING = 2**18  # bytes that a peer has not read, some hundred messages: it will never catch up
_MOST_QUEUED = 4  # messages of a peer that wait to be read; then its socket is not read either
_HURRY = 5.0  # s that a connection may take to say what it wants
_PATIENCE = 1.0  # s that a page has to say goodbye when the server ends
PAGE, _SOURCE = "/page", "/source"


class AvatarServer:
    """A web server on the loopback interface with one page, and WebSockets for the page and for those who drive it.

    Whoever connects must know ``token``, which is new for each server. A source sends ``{"jawOpen": 0.5}`` or an array
    of weights in the order of ``names``; every page applies it and acknowledges, and sources are told so by
    ``{"applied": n}`` when the first page has applied n more messages. What is not understood is answered with
    ``{"error": "..."}`` and not passed on. Who does not read what is sent to him is dropped, and there are at most 32
    connections.

    Parameters
    ----------
    avatar : Path
        A GLB file.
    port : int
        0 takes a free one.

    Raises
    ------
    OSError, ValueError
        If the file cannot be read or is no avatar.
    """

    def __init__(self, avatar: Path, port: int = 0) -> None:
        check_port(port)
        self._glb, document = read_avatar_glb(avatar)
        self.names = target_names(document)
        self.token = secrets.token_urlsafe(24)
        self.port = port
        self._title = avatar.stem
        self._pages: list[Any] = []
        self._sources: list[Any] = []
        self._page = b""
        self._server: Any = None
        self._watched = asyncio.Event()

    @property
    def url(self) -> str:
        """Of the page, with the token."""
        return f"http://{HOST}:{self.port}/?token={self.token}"

    @property
    def source_url(self) -> str:
        """Where :func:`toongeo.driving.send_weights` sends to."""
        return f"ws://{HOST}:{self.port}{_SOURCE}?token={self.token}"

    async def __aenter__(self) -> AvatarServer:
        websockets = load_websockets()
        self._server = await websockets.serve(
            self._talk,
            HOST,
            self.port,
            process_request=self._answer,
            max_size=LARGEST,
            max_queue=_MOST_QUEUED,
            open_timeout=_HURRY,
            close_timeout=_PATIENCE,
            compression=None,
        )
        self.port = self._server.sockets[0].getsockname()[1]
        live = f"ws://{HOST}:{self.port}{PAGE}?token={self.token}"
        self._page = glb_page(self._glb, self._title, live=live).encode()
        return self

    async def __aexit__(self, *error: object) -> None:
        self._server.close()
        await self._server.wait_closed()

    def _answer(self, connection: Any, request: Any) -> Any:
        """None lets a WebSocket begin; anything else is an answer over HTTP."""
        if (refusal := self._refusal(request)) is not None:
            return connection.respond(*refusal)
        path, _ = path_and_token(request.path)
        if path in (PAGE, _SOURCE):
            if len(self._pages) + len(self._sources) < _MOST_PEERS:
                return None
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "too many are connected\n")
        if path != "/":
            return connection.respond(HTTPStatus.NOT_FOUND, "there is nothing here\n")
        response = connection.respond(HTTPStatus.OK, "")
        response.body = self._page
        for name, value in (
            ("Content-Type", "text/html; charset=utf-8"),
            ("Content-Length", str(len(self._page))),
            ("Cache-Control", "no-store"),
            ("Referrer-Policy", "no-referrer"),
            ("X-Content-Type-Options", "nosniff"),
            ("X-Frame-Options", "DENY"),
        ):
            if name in response.headers:
                del response.headers[name]  # a second value would be added, not replace the first
            response.headers[name] = value
        return response

    def _refusal(self, request: Any) -> tuple[HTTPStatus, str] | None:
        _, given = path_and_token(request.path)
        named, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        return refusal(named, origins, given, port=self.port, token=self.token)

    async def _talk(self, connection: Any) -> None:
        is_page = path_and_token(connection.request.path)[0] == PAGE
        members = self._pages if is_page else self._sources
        members.append(connection)
        if is_page:
            self._watched.set()
        try:
            # However a connection ends, a message too large included, the others go on.
            with contextlib.suppress(load_websockets().ConnectionClosed):
                async for message in connection:
                    if not is_page:
                        self._pass_on(connection, message)
                    elif connection is self._pages[0]:
                        self._tell(self._sources, {"applied": acknowledged(message)})
        finally:
            members.remove(connection)

    def _pass_on(self, source: Any, message: str | bytes) -> None:
        try:
            weights = read_message(message, self.names)
        except ValueError as error:
            self._tell([source], {"error": str(error)})
        else:
            self.show(weights)

    @property
    def pages(self) -> int:
        """How many pages are open."""
        return len(self._pages)

    async def first_page(self) -> None:
        """Return when a page has been opened."""
        await self._watched.wait()

    def show(self, weights: dict[str, float]) -> None:
        """Send weights to every page."""
        self._tell(self._pages, weights)

    def _tell(self, connections: list[Any], content: dict[str, Any]) -> None:
        for connection in connections:
            if connection.transport.get_write_buffer_size() > _MOST_WAITING:
                connection.transport.abort()  # a close would wait behind all that was not read
        load_websockets().broadcast(connections, json.dumps(content))


def acknowledged(message: str | bytes) -> int:
    """How many messages a page says that it has applied; 0 if it says something else."""
    digits = str(message)
    return int(digits) if digits.isascii() and digits.isdigit() and len(digits) < 10 else 0
