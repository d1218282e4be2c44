"""Who may talk to the editor."""

import http.client
import json
import socket

import pytest

from tests.app.editor.serving import serving
from toongeo.app.editor.editor_server import LARGEST, EditorServer
from toongeo.app.loopback import HOST

JSON = {"Content-Type": "application/json"}


@pytest.fixture
def server(folder):
    with serving(folder) as server:
        yield server


def answered(server, method, path, body=None, **headers):
    """Status, headers and body of an answer."""
    connection = http.client.HTTPConnection(HOST, server.port, timeout=20)
    try:
        connection.request(method, path, body, headers)
        response = connection.getresponse()
        return response.status, dict(response.getheaders()), response.read().decode(errors="replace")
    finally:
        connection.close()


def bearer(server):
    return {"Authorization": f"Bearer {server.token}"}


def test_the_page_is_for_those_who_know_the_token(server):
    status, headers, body = answered(server, "GET", server.url.partition(str(server.port))[2])
    assert status == 200 and headers["Content-Type"].startswith("text/html") and "<title>Landmarks" in body
    assert headers["Cache-Control"] == "no-store" and headers["X-Frame-Options"] == "DENY"
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "connect-src 'self'" in policy and "unsafe" not in policy
    assert len(server.token) >= 32 and "Copyright © 2010-2026 three.js authors" in body


def test_questions_and_pictures(server):
    status, _, body = answered(server, "POST", "/ask/list", "{}", **JSON, **bearer(server))
    assert status == 200 and json.loads(body) == {"pictures": [{"name": "face.png", "done": False}]}
    status, headers, body = answered(server, "GET", "/picture/0", **bearer(server))
    assert status == 200 and headers["Content-Type"] == "image/jpeg"
    status, _, body = answered(server, "POST", "/ask/open", '{"picture": 7}', **JSON, **bearer(server))
    assert status == 422 and body == "picture: expected a number below 1, got 7"


@pytest.mark.parametrize(
    ("method", "path", "headers", "code"),
    [
        ("GET", "/", {}, 401),
        ("GET", "/?token=", {}, 401),
        ("GET", "/?token=wrong", {}, 401),
        ("GET", "/picture/0", {}, 401),
        ("GET", "/picture/0", {"Authorization": "Bearer wrong"}, 401),
        ("GET", "/picture/0", {"Authorization": "{token}"}, 401),
        ("GET", "/picture/0?token={token}", {}, 401),
        ("POST", "/ask/list", JSON, 401),
        ("POST", "/ask/list", JSON | {"Authorization": "Bearer é"}, 401),
        ("GET", "/?token={token}", {"Origin": "https://example.org"}, 403),
        ("GET", "/?token={token}", {"Origin": "null"}, 403),
        ("GET", "/?token={token}", {"Host": "example.org"}, 403),
        ("POST", "/ask/list", JSON | {"Authorization": "Bearer {token}", "Origin": "http://127.0.0.1:1"}, 403),
        ("POST", "/ask/list", JSON | {"Authorization": "Bearer {token}", "Host": "evil.example:80"}, 403),
        ("POST", "/ask/list", {"Authorization": "Bearer {token}", "Content-Type": "text/plain"}, 400),
        ("GET", "/picture/1", {"Authorization": "Bearer {token}"}, 404),
        ("GET", "/picture/../etc/passwd", {"Authorization": "Bearer {token}"}, 404),
        ("GET", "/picture/²", {"Authorization": "Bearer {token}"}, 404),
        ("PUT", "/ask/list", {"Authorization": "Bearer {token}"}, 501),
    ],
)
def test_others_get_nothing(server, method, path, headers, code):
    headers = {name: value.replace("{token}", server.token).encode() for name, value in headers.items()}
    path = path.replace("{token}", server.token).replace("²", "%C2%B2")
    status, _, body = answered(server, method, path, "{}" if method != "GET" else None, **headers)
    assert status == code and server.token not in body


@pytest.mark.parametrize(
    ("body", "code", "text"),
    [
        ("{", 422, "expected JSON, but"),
        ("[" * 9000, 422, "expected JSON, but"),
        ("[]", 422, "expected an object"),
        ("x" * (LARGEST + 1), 413, "expected at most 65536 bytes"),
    ],
    ids=["half", "deep", "list", "large"],
)
def test_bodies_that_are_none(server, body, code, text):
    status, _, answer = answered(server, "POST", "/ask/list", body, **JSON, **bearer(server))
    assert status == code and answer.startswith(text)


def test_a_length_is_asked_for(server):
    with socket.create_connection((HOST, server.port), timeout=10) as raw:
        head = f"POST /ask/list HTTP/1.1\r\nHost: {HOST}:{server.port}\r\nAuthorization: Bearer {server.token}\r\n"
        raw.sendall(f"{head}Content-Type: application/json\r\n\r\n".encode())
        assert raw.recv(64).startswith(b"HTTP/1.1 400")


def test_two_hosts_are_one_too_many(server):
    with socket.create_connection((HOST, server.port), timeout=10) as raw:
        own = f"Host: {HOST}:{server.port}\r\n"
        raw.sendall(f"GET /?token={server.token} HTTP/1.1\r\n{own}Host: example.org\r\n\r\n".encode())
        assert raw.recv(64).startswith(b"HTTP/1.1 403")


def test_only_the_loopback_interface_listens(server):
    assert server.server_address[0] == "127.0.0.1"


def test_a_port_that_is_taken(server):
    with pytest.raises(OSError, match="in use"):
        EditorServer(server.session, server.port)


def test_nothing_is_printed(server, capfd):
    answered(server, "GET", "/?token=wrong")
    assert capfd.readouterr() == ("", "")
