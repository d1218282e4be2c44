"""Peers of the landmark editor that mean harm, or do not care."""

import re
import socket
import time
from urllib.parse import quote

import pytest

from tests.app.editor.serving import serving
from tests.app.editor.test_editor_server import JSON, answered, bearer
from toongeo.app.editor import editor_server
from toongeo.app.editor.editor_server import EditorServer
from toongeo.app.loopback import HOST


@pytest.fixture
def server(folder):
    with serving(folder) as server:
        yield server


def is_served(server):
    return answered(server, "POST", "/ask/list", "{}", **JSON, **bearer(server))[0] == 200


def test_silent_and_slow_peers_take_a_bounded_number_of_threads(folder, monkeypatch):
    monkeypatch.setattr(editor_server, "_MOST_PEERS", 5)
    monkeypatch.setattr(editor_server._Handler, "timeout", 0.5)
    with serving(folder) as server:
        peers = [socket.create_connection((HOST, server.port)) for _ in range(5)]
        peers[0].sendall(b"POST /ask/list HTTP/1.1\r\nContent-Length: 65536\r\n")
        peers[1].sendall(b"G")
        time.sleep(0.1)
        late = socket.create_connection((HOST, server.port), timeout=5)
        assert late.recv(1) == b""  # hung up at once
        time.sleep(0.8)  # the silent ones are given up
        assert is_served(server)
        for sock in (*peers, late):
            sock.close()


@pytest.mark.parametrize(
    "line",
    [
        b"GET /" + b"a" * 70_000 + b" HTTP/1.1\r\n\r\n",
        b"\xff\xfe\0\0\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"BREW /pot HTTP/1.1\r\nHost: x\r\n\r\n",
        b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 200 + b"\r\n",
        b"POST /ask/list HTTP/1.1\r\nContent-Length: -5\r\n\r\n",
        b"POST /ask/list HTTP/1.1\r\nContent-Length: 99999999999999\r\n\r\n",
        b"GET http://[ HTTP/1.1\r\n\r\n",
        b"POST /ask/list HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffff\r\n",
    ],
)
def test_malformed_requests_are_answered_or_hung_up_on(server, line, capfd):
    with socket.create_connection((HOST, server.port), timeout=20) as sock:
        sock.sendall(line)
        answer = b""
        while part := sock.recv(65536):
            answer += part
            assert len(answer) < 10_000
    assert not answer or re.search(rb"\b[45]\d\d\b", answer)
    assert is_served(server)
    assert not capfd.readouterr().err  # no traceback where somebody works


@pytest.mark.parametrize("length", ["9" * 5000, "65537", "4" * 12])
def test_questions_that_are_too_long_are_refused_before_they_are_read(server, length, capfd):
    head = f"POST /ask/list HTTP/1.1\r\nHost: {HOST}:{server.port}\r\nAuthorization: Bearer {server.token}\r\n"
    with socket.create_connection((HOST, server.port), timeout=20) as sock:
        sock.sendall(f"{head}Content-Type: application/json\r\nContent-Length: {length}\r\n\r\n".encode())
        assert b" 413 " in sock.recv(4096)
    assert not capfd.readouterr().err


@pytest.mark.parametrize(
    "path", ["/picture/../../etc/passwd", "/picture/%2e%2e", "/picture/1e3", "/picture/-1", "/picture/٣"]
)
def test_pictures_have_numbers_and_no_paths(server, path):

    assert answered(server, "GET", quote(path, safe="/%"), **bearer(server))[0] == 404


BODIES = [
    "[" * 30_000,
    '{"picture": 1' + 5000 * "0" + "}",
    '{"picture": "../x"}',
    '{"picture": 1e999}',
    '{"picture": null}',
    "5",
]


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("question", ["open", "fit", "save", "place", "../open", "__class__"])
def test_nonsense_is_told_to_the_page(server, question, body):
    status, _, text = answered(server, "POST", f"/ask/{question}", body, **JSON, **bearer(server))
    assert status == 422 and len(text) < 600 and "Traceback" not in text


@pytest.mark.parametrize("port", [99_999, -1])
def test_ports_that_are_none(server, port):
    with pytest.raises(ValueError, match="port: expected 0"):
        EditorServer(server.session, port)
