"""Who may talk to a live avatar, and what it understands."""

import asyncio
import json
import socket
import threading
import urllib.error
import urllib.request

import numpy as np
import pytest

from tests.app.running import running
from toongeo.app.cli import main
from toongeo.app.live.avatar_server import LARGEST, PAGE, AvatarServer, acknowledged
from toongeo.app.live.read_message import read_message
from toongeo.app.loopback import HOST
from toongeo.driving import Take, send_weights
from toongeo.driving.websockets_adapter import load_websockets
from toongeo.model.expression_schemes import EXPRESSIONS

pytest.importorskip("websockets", reason="needs the extra `serve`")

NAMES = ("eyeBlinkLeft", "jawOpen")


@pytest.fixture(scope="module")
def glb(avatar, tmp_path_factory):
    path = tmp_path_factory.mktemp("serve") / "face.glb"
    avatar.save(path, texture=None, animation=None, loadable=False, quantize=True)
    return path


@pytest.fixture(scope="module")
def server(glb):
    with running(glb) as server:
        yield server


def page_socket(server, path=PAGE, **options):
    address = f"ws://{HOST}:{server.port}{path}?token={server.token}"
    return load_websockets().connect(address, compression=None, proxy=None, **options)


def acknowledging(page, count, seen):
    for _ in range(count):
        seen.append(json.loads(page.recv(timeout=10)))
        page.send("1")


def test_weights_reach_the_page_and_are_acknowledged(server):
    seen = []
    with page_socket(server) as page:
        reader = threading.Thread(target=acknowledging, args=(page, 201, seen))
        reader.start()
        frames = [{"jawOpen": k / 200} for k in range(200)]
        assert send_weights(server.source_url, frames) == 200
        assert send_weights(server.source_url, [np.linspace(0, 1, len(server.names))], fps=100) == 1
        reader.join()
    assert seen[:200] == frames and seen[200][server.names[-1]] == 1.0


def test_a_take_is_played_from_when_a_page_is_there(glb):
    weights = np.zeros((4, 54))
    weights[:, EXPRESSIONS.index("jawOpen")] = 0.1, 0.2, 0.3, 0.4
    with running(glb, take=Take.of_frames(weights, 60)) as server, page_socket(server) as page:
        played = [json.loads(page.recv(timeout=10))["jawOpen"] for _ in range(4)]
    assert played == [0.1, 0.2, 0.3, 0.4]


def test_the_face_before_a_camera_is_shown(glb, performance, capsys):
    """At rest at first, then the jaw opens."""
    frames = [performance.frames[k] for k in (2, 2, 2, 2, 2, 2, 2, 2, 3, 4, 5, 6)]
    with (
        running(glb, camera=[(frame, k / 10) for k, frame in enumerate(frames)]) as server,
        page_socket(server) as page,
    ):
        seen = [json.loads(page.recv(timeout=60)) for _ in frames]
    opened = [weights["jawOpen"] for weights in seen]
    assert opened[:8] == [0] * 8 and max(opened) > 0.2 and set(seen[0]) == set(server.names)
    assert "look into the camera without expression\nthe face is known" in capsys.readouterr().out


def test_a_camera_that_is_not_there_is_named(glb, tmp_path, capsys):
    for camera, message in (("97", "camera 97: there is none"), (str(tmp_path / "none.mp4"), "none.mp4")):
        assert main(["serve", str(glb), "--camera", camera, "--no-open"]) == 2
        assert message in capsys.readouterr().err


def fetched(url, **headers):
    with urllib.request.urlopen(urllib.request.Request(url, headers=headers), timeout=10) as answer:
        return answer.status, dict(answer.headers), answer.read().decode()


def test_the_page_is_for_those_who_know_the_token(server):
    status, headers, body = fetched(server.url)
    assert status == 200 and headers["Content-Type"].startswith("text/html")
    assert headers["Cache-Control"] == "no-store" and headers["X-Frame-Options"] == "DENY"
    assert f"connect-src blob: data: ws://{HOST}:{server.port}{PAGE};" in body
    assert len(server.token) >= 32


@pytest.mark.parametrize(
    ("change", "headers", "code"),
    [
        (lambda url: url[:-1], {}, 401),
        (lambda url: url.split("?")[0], {}, 401),
        (lambda url: url.replace("/?", "/other?"), {}, 404),
        (lambda url: url, {"Origin": "https://example.org"}, 403),
        (lambda url: url, {"Origin": "null"}, 403),
        (lambda url: url, {"Host": "example.org"}, 403),
    ],
)
def test_others_get_nothing(server, change, headers, code):
    with pytest.raises(urllib.error.HTTPError) as error:
        fetched(change(server.url), **headers)
    assert error.value.code == code and server.token not in error.value.read().decode()
    error.value.close()


def test_two_hosts_or_origins_are_one_too_many(server):
    """A second header must neither pass nor disturb the server."""
    for name, own in (("Host", f"{HOST}:{server.port}"), ("Origin", f"http://{HOST}:{server.port}")):
        lines = {"Host": f"Host: {HOST}:{server.port}\r\n", name: f"{name}: {own}\r\n{name}: http://example.org\r\n"}
        with socket.create_connection((HOST, server.port), timeout=10) as raw:
            raw.sendall(f"GET /?token={server.token} HTTP/1.1\r\n{''.join(lines.values())}\r\n".encode())
            assert raw.recv(64).startswith(b"HTTP/1.1 403")


def test_sockets_of_others_are_refused(server):
    refused = load_websockets().InvalidStatus
    for origin in ("https://example.org", "null", f"http://{HOST}:1"):
        with pytest.raises(refused, match="403"), page_socket(server, origin=origin):
            pass
    with page_socket(server, origin=f"http://{HOST}:{server.port}"):
        pass
    with pytest.raises(ValueError, match="url: the server refuses it .*401"):
        send_weights(server.source_url + "x", [{"jawOpen": 1}])


@pytest.mark.parametrize(("message", "count"), [("12", 12), ("", 0), ("-1", 0), (b"1", 0), ("9" * 99, 0), ("²", 0)])
def test_acknowledgements_are_numbers(message, count):
    assert acknowledged(message) == count


def test_two_servers_have_two_tokens(glb):
    assert AvatarServer(glb).token != AvatarServer(glb).token


def test_what_is_not_understood_is_not_passed_on(server):
    seen = []
    with page_socket(server) as page:
        reader = threading.Thread(target=acknowledging, args=(page, 1, seen))
        reader.start()
        with pytest.raises(ValueError, match="frames: weights: no expression 'jawOpn'; did you mean jawOpen"):
            send_weights(server.source_url, [{"jawOpn": 1}])
        with pytest.raises(ConnectionError, match="1009"):
            send_weights(server.source_url, [{"x" * LARGEST: 1}])
        send_weights(server.source_url, [{"jawOpen": 1}])
        reader.join()
    assert seen == [{"jawOpen": 1.0}]


def test_no_page_and_no_server(server):
    with pytest.raises(TimeoutError, match="no page has applied more than 0 of 1 frames in 0.1 s"):
        send_weights(server.source_url, [{"jawOpen": 1}], timeout=0.1)
    with socket.socket() as free:
        free.bind((HOST, 0))
        port = free.getsockname()[1]
    with pytest.raises(OSError, match="refused"):
        send_weights(f"ws://{HOST}:{port}/source?token=x", [{"jawOpen": 1}])


def test_only_the_loopback_interface_listens(server):
    addresses = {listener.getsockname()[0] for listener in server._server.sockets}
    assert addresses == {"127.0.0.1"}


def test_a_port_that_is_taken(glb, server):
    async def start():
        async with AvatarServer(glb, server.port):
            pass

    with pytest.raises(OSError, match="address already in use|in use"):
        asyncio.run(start())


@pytest.mark.parametrize(
    ("message", "weights"),
    [
        ('{"jawOpen": 0.5}', {"jawOpen": 0.5}),
        (b"[0.25, 1]", {"eyeBlinkLeft": 0.25, "jawOpen": 1.0}),
        ("{}", {}),
    ],
)
def test_messages(message, weights):
    assert read_message(message, NAMES) == weights


@pytest.mark.parametrize(
    ("message", "error"),
    [
        ("jawOpen", "message: expected JSON"),
        (b"\xff", "message: expected JSON"),
        ("[" * 8000, "message: expected JSON"),
        ("0.5", "message: expected an object of weights, or an array of numbers"),
        ("[true, 0]", "message: expected an object"),
        ('["a", "b"]', "message: expected an object"),
        ("[0.5]", "weights: expected 2 values"),
        ('{"jawOpen": NaN}', "weights: expected finite"),
        ('{"jawOpen": "1"}', "weights: expected a number for jawOpen, got '1'"),
        ('{"nose": 1}', "weights: no expression 'nose'"),
        ("[1e999, 0]", "weights: expected finite"),
    ],
)
def test_messages_that_are_none(message, error):
    with pytest.raises(ValueError, match=error):
        read_message(message, NAMES)


def test_without_websockets_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "websockets.asyncio.server", None)
    with pytest.raises(ImportError, match='pip install "websockets>='):
        load_websockets()
