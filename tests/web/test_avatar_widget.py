"""Weights between a notebook's code and its page: the side of the page, in a frame that may do nothing else."""

import functools
import json
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest

from tests.conftest import ROOT
from toongeo.io import Scene, SceneMesh, encode_glb, page_html
from toongeo.io.shown_page import ShownPage

# A notebook's side of anywidget, of which only these are used.
PAGE = """<!doctype html><html lang="en"><title>Notebook</title><body><script type="module">
import widget from './widget.js';
const state = await (await fetch('./state.json')).json();
const heard = new Set();
window.model = {
  get: (name) => state[name],
  set: (name, value) => { state[name] = value; heard.forEach((act) => act()); },
  save_changes: () => { window.saved = { ...state.weights }; },
  on: (event, act) => heard.add(act),
  off: (event, act) => heard.delete(act),
};
window.leave = widget.render({ model: window.model, el: document.body });
window.listeners = () => heard.size;
</script>"""


@pytest.fixture
def page():
    names = ("jawOpen", "mouthSmileLeft")
    mesh = SceneMesh("head", 100 * np.eye(3), np.array([[0, 1, 2]]), targets=np.ones((2, 3, 3)), target_names=names)
    presets = {"yawn": {"jawOpen": 0.75}}
    return page_html(encode_glb(Scene((mesh,))), title="small", presets=presets, framed=True)


@pytest.fixture
def notebook(tmp_path, page):
    """The address of a notebook with the widget."""
    (tmp_path / "index.html").write_text(PAGE)
    (tmp_path / "widget.js").write_text((ROOT / "toongeo" / "io" / "page" / "widget.js").read_text())
    state = {"settings": {"page": page, "height": 400}, "weights": {"jawOpen": 0.5, "mouthSmileLeft": 0}}
    (tmp_path / "state.json").write_text(json.dumps(state))

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_):
            """Nothing."""

    with ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=tmp_path)) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}/"
        server.shutdown()
        thread.join()


def test_weights_go_to_the_page_and_come_back(notebook, browse):
    moved = {"frame": "toongeo.weights()"}
    steps = [{"frame": "document.documentElement.dataset.ready", "until": "true"}]
    steps += [{"wait": "window.listeners?.() === 1"}, {"frame": "toongeo.weights().jawOpen", "until": 0.5}, moved]
    steps += [{"run": "model.set('weights', { jawOpen: 0.25, mouthSmileLeft: 1 }); window.saved ?? null"}]
    steps += [{"frame": "toongeo.weights().mouthSmileLeft", "until": 1}, moved]
    steps += [
        {"frame": "document.querySelector('#presets button').click()"},
        {"wait": "window.saved?.jawOpen === 0.75"},
    ]
    steps += [{"run": "model.get('weights')"}, {"frame": "document.getElementById('link').hidden"}]
    steps += [{"run": "leave(); listeners()"}, {"axe": "document"}]
    report, _ = browse(notebook, steps)
    first, unsaved, second, _, told, hidden, left, violations = report["results"]
    assert first == {"jawOpen": 0.5, "mouthSmileLeft": 0} and unsaved is None
    assert second == {"jawOpen": 0.25, "mouthSmileLeft": 1}
    assert told == {"jawOpen": 0.75, "mouthSmileLeft": 0} and hidden is True
    assert left == 0
    assert [name for name, _ in violations if name not in ("landmark-one-main", "page-has-heading-one", "region")] == []
    assert [line for line in report["console"] if "favicon" not in line and "404" not in line] == []


def test_a_shown_page_runs_in_its_frame(browse, tmp_path, page):
    (tmp_path / "cell.html").write_text(f"<!doctype html><title>x</title>{ShownPage(page, 300, 'x')._repr_html_()}")
    steps = [{"frame": "document.documentElement.dataset.ready", "until": "true"}]
    steps += [{"frame": "toongeo.names"}, {"frame": "window.origin"}]
    report, _ = browse((tmp_path / "cell.html").as_uri(), steps)
    assert report["results"] == [["jawOpen", "mouthSmileLeft"], "null"] and report["console"] == []
