"""Peers of a live avatar that mean harm, or do not care."""

import base64
import json
import os
import socket
import time

import pytest

from tests.app.live.test_serve import glb as glb
from tests.app.live.test_serve import page_socket
from tests.app.running import running
from toongeo.app.live import avatar_server
from toongeo.app.live.avatar_server import PAGE, AvatarServer
from toongeo.app.loopback import HOST
from toongeo.driving import send_weights
from toongeo.driving.websockets_adapter import load_websockets

pytest.importorskip("websockets", reason="needs the extra `serve`")


@pytest.fixture
def server(glb):
    with running(glb) as server:
        yield server


def raw(server, path, **headers):
    """A socket after the handshake of WebSockets, of which nothing more will be read; and what was answered."""
    sock = socket.socket()
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    sock.settimeout(10)
    sock.connect((HOST, server.port))
    key = base64.b64encode(os.urandom(16)).decode()
    given = {
        "Host": f"{HOST}:{server.port}",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Key": key,
        "Sec-WebSocket-Version": "13",
    } | headers
    lines = [f"GET {path} HTTP/1.1", *(f"{name}: {value}" for name, value in given.items()), "", ""]
    sock.sendall("\r\n".join(lines).encode())
    answer = b""
    while b"\r\n\r\n" not in answer:
        if not (part := sock.recv(1)):
            break
        answer += part
    return sock, answer.decode().partition("\r\n")[0]


def until(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it did not come to pass"
        time.sleep(0.02)


def test_a_page_that_never_reads_is_dropped_and_others_go_on(server):
    lazy, answer = raw(server, f"{PAGE}?token={server.token}")
    assert "101" in answer
    until(lambda: server.pages == 1)
    content = json.dumps([0.123456789] * len(server.names))
    with page_socket(server, "/source") as source:
        for _ in range(60_000):  # what the system holds for him is some MB
            source.send(content)
            if server.pages == 0:
                break
    until(lambda: server.pages == 0)
    lazy.close()
    with page_socket(server) as page, page_socket(server, "/source") as source:
        source.send(json.dumps({"jawOpen": 0.5}))
        assert json.loads(page.recv(timeout=10)) == {"jawOpen": 0.5}


def test_there_are_at_most_so_many_connections(server, monkeypatch):
    monkeypatch.setattr(avatar_server, "_MOST_PEERS", 3)
    path = f"{PAGE}?token={server.token}"
    held = [raw(server, path) for _ in range(3)]
    until(lambda: server.pages == 3)
    refused, answer = raw(server, path)
    assert [a for _, a in held] == ["HTTP/1.1 101 Switching Protocols"] * 3 and " 503 " in f"{answer} "
    for sock, _ in [*held, (refused, "")]:
        sock.close()
    until(lambda: server.pages == 0)
    with page_socket(server):
        until(lambda: server.pages == 1)


HUGE = "1" + 400 * "0"
ODD = [
    json.dumps([0] * 53).replace("[0", f"[{HUGE}, 0", 1),
    f'{{"jawOpen": {HUGE}}}',
    f'{{"jawOpen": {12 * HUGE}}}',
    '{"jawOpen": 1e300}',
    '{"jawOpen": {}}',
    "[[]]",
    "[" * 9000,
    "\0",
    "nul",
    '{"\\udcff": 1}',
    '{"constructor": 1}',
]


def test_numbers_beyond_floats_and_other_nonsense_do_not_end_a_connection(server):
    with page_socket(server, "/source") as source, page_socket(server) as page:
        for message in [*ODD, b"\xff\xfe", json.dumps({"eyeBlinkLeft": True}).replace("true", "[]")]:
            source.send(message)
            assert "error" in json.loads(source.recv(timeout=10)), message
        source.send(json.dumps({"jawOpen": 0.25}))
        assert json.loads(page.recv(timeout=10)) == {"jawOpen": 0.25}


def test_frames_that_are_too_large_or_none_end_only_their_own_connection(server):
    masked = b"\x81\xfe\xff\xff" + bytes(4) + b"x" * 65535
    with page_socket(server, "/source") as good, page_socket(server) as page:
        for junk in (99 * b"\xff", b"\x82\xff" + 8 * b"\xff", b"\x81\x05hello", masked):
            sock, answer = raw(server, f"/source?token={server.token}")
            assert "101" in answer
            sock.sendall(junk)
            while sock.recv(4096):  # until the server has hung up
                pass
            sock.close()
        good.send(json.dumps({"jawOpen": 0.75}))
        assert json.loads(page.recv(timeout=10)) == {"jawOpen": 0.75}


def test_silent_peers_keep_nobody_out(server):
    silent = [socket.create_connection((HOST, server.port)) for _ in range(40)]
    silent[0].sendall(b"GET / HTTP/1.1\r\nHost: ")
    with page_socket(server):
        until(lambda: server.pages == 1)
    for sock in silent:
        sock.close()


@pytest.mark.parametrize(
    "change",
    [
        {"Origin": "https://example.org"},
        {"Origin": "null"},
        {"Host": "evil.example"},
        {"Host": "127.0.0.1"},
    ],
)
def test_other_origins_and_hosts_get_no_socket(server, change):
    sock, answer = raw(server, f"{PAGE}?token={server.token}", **change)
    assert " 403 " in f"{answer} "
    sock.close()


@pytest.mark.parametrize("path", ["/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/page/../x", "//page", "/source/"])
def test_there_is_nothing_but_the_page(server, path):
    sock, answer = raw(server, f"{path}?token={server.token}")
    assert " 404 " in f"{answer} "
    sock.close()


def test_a_target_that_is_no_address_is_refused_without_a_traceback(server, caplog):
    sock, answer = raw(server, f"http://[?token={server.token}")
    assert " 401 " in f"{answer} "
    sock.close()
    assert not caplog.records


@pytest.mark.parametrize("port", [99_999, -1, 70_000, True, 1.5])
def test_ports_that_are_none(glb, port):
    with pytest.raises(ValueError, match="port: expected 0"):
        AvatarServer(glb, port)


@pytest.mark.parametrize("url", ["notaurl", "file:///etc/passwd", "http://127.0.0.1:1/", "ws://"])
def test_addresses_that_are_none(url):
    with pytest.raises(ValueError, match="url: expected ws://"):
        send_weights(url, [{}])


def test_what_is_no_server_of_ours_is_named(server):
    with socket.create_server((HOST, 0)) as other:
        other.settimeout(10)
        import threading

        def hello():
            peer, _ = other.accept()
            peer.recv(4096)
            peer.sendall(b"HTTP/1.1 200 OK\r\n\r\nhello")
            peer.close()

        thread = threading.Thread(target=hello)
        thread.start()
        with pytest.raises(ValueError, match="url: "):
            send_weights(f"ws://{HOST}:{other.getsockname()[1]}/", [{}])
        thread.join()
    assert load_websockets().InvalidURI
