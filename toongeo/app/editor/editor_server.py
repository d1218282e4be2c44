"""The web server of the landmark editor and of the picker, on this computer only."""

from __future__ import annotations

import json
import os
import secrets
import sys
import threading
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from toongeo.app.editor.protocols import Session
from toongeo.app.loopback import HOST, check_port, path_and_token, refusal
from toongeo.io.editor_page import editor_page

__all__ = ["LARGEST", "EditorServer"]

LARGEST = 65_536  # bytes of a question; 68 points with all their digits take 3,000
_MOST_PEERS = 32  # connections at once; a browser opens six
_PATIENCE = 30.0  # s until a connection that says nothing is closed
_SCHEME = "Bearer "


class EditorServer(ThreadingHTTPServer):
    """Serves the page of a session on the loopback interface, and answers it.

    Whoever asks must know ``token``, which is new for each server: in the address of the page, and in the header
    ``Authorization`` of everything else, which no other page can send along.

    Parameters
    ----------
    session : Session
    port : int
        0 takes a free one.

    Raises
    ------
    OSError
        If the port is taken.
    """

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would let two servers share a port

    def __init__(self, session: Session, port: int = 0) -> None:
        check_port(port)
        self._free = threading.BoundedSemaphore(_MOST_PEERS)
        self.session = session
        self.token = secrets.token_urlsafe(24)
        self.page, self.policy = editor_page(session.settings() | {"token": self.token}, title=session.title)
        super().__init__((HOST, port), _Handler)
        self.port = int(self.server_address[1])

    def process_request(self, request: Any, client_address: Any) -> None:
        """In a thread of its own, if there are not too many."""
        if self._free.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Until the connection ends."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._free.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Browsers that hang up are no error."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)

    @property
    def url(self) -> str:
        """Of the page, with the token."""
        return f"http://{HOST}:{self.port}/?token={self.token}"


class _Handler(BaseHTTPRequestHandler):
    """GET gives the page and the pictures, POST answers questions."""

    server: EditorServer
    protocol_version = "HTTP/1.1"
    timeout = _PATIENCE

    def do_GET(self) -> None:
        path, token = path_and_token(self.path)
        given = token if path == "/" else self._bearer()
        if self._is_refused(given):
            return
        if path == "/":
            self._reply(HTTPStatus.OK, "text/html; charset=utf-8", self.server.page.encode())
            return
        _, _, number = path.partition("/picture/")
        if not (
            number.isascii() and number.isdigit() and len(number) < 8 and int(number) < self.server.session.n_pictures
        ):
            self._refuse(HTTPStatus.NOT_FOUND, "there is nothing here\n")
            return
        self._try(lambda: self._reply(HTTPStatus.OK, "image/jpeg", self.server.session.shown_picture(int(number))))

    def do_POST(self) -> None:
        if self._is_refused(self._bearer()):
            return
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdigit()) or self.headers.get_content_type() != "application/json":
            self._refuse(HTTPStatus.BAD_REQUEST, "expected JSON of a known length\n")
        elif len(length) > 9 or int(length) > LARGEST:  # Python refuses to read 5,000 digits
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"expected at most {LARGEST} bytes\n")
        else:
            body = self.rfile.read(int(length))
            self._try(lambda: self._answer(body))

    def _answer(self, body: bytes) -> None:
        try:
            message = json.loads(body)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"expected JSON, but {error}") from error
        if not isinstance(message, dict):
            raise ValueError("expected an object")
        answer = self.server.session.answer(path_and_token(self.path)[0].removeprefix("/ask/"), message)
        self._reply(HTTPStatus.OK, "application/json", json.dumps(answer, allow_nan=False).encode())

    def _try(self, reply: Any) -> None:
        """What the user can mend is told to the page."""
        try:
            reply()
        except (ValueError, OSError, RuntimeError) as error:
            if isinstance(error, ConnectionError):
                raise
            self._reply(HTTPStatus.UNPROCESSABLE_ENTITY, "text/plain; charset=utf-8", str(error).encode())

    def _bearer(self) -> str:
        given = self.headers.get("Authorization", "")
        return given.removeprefix(_SCHEME) if given.startswith(_SCHEME) else ""

    def _is_refused(self, given: str) -> bool:
        hosts, origins = self.headers.get_all("Host", []), self.headers.get_all("Origin", [])
        refused = refusal(hosts, origins, given, port=self.server.port, token=self.server.token)
        if refused is not None:
            self._refuse(*refused)
        return refused is not None

    def _refuse(self, status: HTTPStatus, text: str) -> None:
        self.close_connection = True  # a body that was not read would be taken for the next request
        self._reply(status, "text/plain; charset=utf-8", text.encode())

    def _reply(self, status: HTTPStatus, kind: str, body: bytes) -> None:
        self.send_response(status)
        for name, value in (
            ("Content-Type", kind),
            ("Content-Length", str(len(body))),
            ("Content-Security-Policy", self.server.policy),
            ("Cache-Control", "no-store"),
            ("Referrer-Policy", "no-referrer"),
            ("X-Content-Type-Options", "nosniff"),
            ("X-Frame-Options", "DENY"),
            ("Cross-Origin-Resource-Policy", "same-origin"),
        ):
            self.send_header(name, value)
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(body)

    def version_string(self) -> str:
        return "toongeo"

    def log_message(self, format: str, *args: object) -> None:
        """Nothing: the address holds the token."""
