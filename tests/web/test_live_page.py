"""A real browser takes weights while they come, acknowledges each, and tells nobody else."""

import json
import threading

import numpy as np
import pytest

from toongeo.driving import send_weights
from toongeo.io import read_video

pytest.importorskip("websockets", reason="needs the extra `serve`")

from tests.app.running import running
from toongeo.app.video.write_video import write_video

LIVE = {"wait": "document.getElementById('status').textContent.startsWith('Live')"}
MESSAGES = 1000


def test_a_thousand_messages_are_applied(avatar, browse, tmp_path):
    path = tmp_path / "face.glb"
    avatar.save(path, loadable=False, quantize=True, animation=None)
    applied = []
    with running(path) as server:

        def drive():
            # All expressions at once, which a computer without a graphics card draws slowly; then two of them.
            every = np.random.default_rng(0).random((MESSAGES, len(server.names)))
            every[-1] = 0.5
            applied.append(send_weights(server.source_url, every, timeout=60))
            frames = ({"jawOpen": k / MESSAGES, "eyeBlinkLeft": 0.25} for k in range(1, MESSAGES + 1))
            applied.append(send_weights(server.source_url, frames, timeout=60))

        source = threading.Thread(target=lambda: (server_has_page(server), drive()))
        source.start()
        report, _ = browse(
            server.url,
            [
                LIVE,
                {"wait": "toongeo.weights().jawOpen === 1"},
                {"wait": "document.querySelector('input[name=jawOpen]').value === '1'"},
                {"run": "toongeo.weights()"},
                {"run": f"fetch('http://127.0.0.1:{server.port}/').then(() => 'fetched', () => 'refused')"},
            ],
        )
        source.join()
        origin = server.url.partition("?")[0]
    weights, fetched = report["results"]
    assert applied == [MESSAGES, MESSAGES]
    assert weights == {**dict.fromkeys(weights, 0.5), "jawOpen": 1, "eyeBlinkLeft": 0.25} and len(weights) == 54
    assert fetched == "refused"  # by the page's own policy
    assert all(url.startswith((origin, "blob:", "ws://127.0.0.1:")) for url in report["requests"])
    assert [line for line in report["console"] if "Content Security Policy" not in line and "Fetch" not in line] == []


@pytest.mark.slow
def test_the_face_before_a_camera_moves_the_page(avatar, performance, browse, tmp_path):
    """A film stands in for the camera: its actor rests, then the mouth is open. It waits for whoever is slow."""
    path, film = tmp_path / "face.glb", tmp_path / "camera.mp4"
    write_video(film, [performance.frames[k] for k in [2] * 8 + [6] * 6], 240, 10)
    camera = ((frame, k / 10) for k, frame in enumerate(read_video(film)))
    avatar.save(path, loadable=False, quantize=True, animation=None)
    with running(path, camera=camera) as server:
        steps = [LIVE, {"wait": "toongeo.weights().jawOpen > 0.3"}, {"run": "toongeo.weights()"}]
        report, _ = browse(server.url, steps)
    (weights,) = report["results"]
    assert weights["jawOpen"] > 0.3 and all(0 <= weight <= 1 for weight in weights.values())
    assert report["console"] == []


def server_has_page(server):
    """Return when the server has a page."""
    for _ in range(2400):
        if server.pages:
            return
        threading.Event().wait(0.05)
    raise AssertionError("no page came")


def test_messages_are_small():
    """54 weights by name, with all digits, are a fraction of what is taken."""
    from toongeo.app.live.avatar_server import LARGEST
    from toongeo.model.expression_schemes import EXPRESSIONS

    assert len(json.dumps(dict.fromkeys(EXPRESSIONS, float(np.pi)))) < LARGEST / 4
