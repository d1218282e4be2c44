"""The editor as a notebook shows it, two of them in one page, with a kernel that is this process."""

import base64
import json
import threading
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest

from tests.web.editing import TRUTH, results

pytestmark = pytest.mark.slow

PAGE = """<!doctype html><html lang="en"><title>Notebook</title>
<link rel="stylesheet" href="./editor.css"><body><main id="one"></main><main id="two"></main>
<script type="module">
import editor from './editor.js';
const settings = await (await fetch('./settings')).json();
for (const [name, id] of [['one', 'one'], ['two', 'two']]) {
  let hear;
  const model = {
    get: (trait) => ({ settings })[trait],
    on: (event, act) => { hear = act; },
    send: async (message) => {
      const reply = await (await fetch('./' + name, { method: 'POST', body: JSON.stringify(message) })).json();
      const bytes = reply.bytes && Uint8Array.from(atob(reply.bytes), (letter) => letter.charCodeAt(0));
      hear(reply.content, bytes ? [new DataView(bytes.buffer)] : []);
    },
  };
  editor.render({ model, el: document.getElementById(id) });
}
</script>"""

DOUBLED_IDS = """(() => {
  const ids = [...document.querySelectorAll('[id]')].map((part) => part.id);
  return ids.length - new Set(ids).size;
})()"""


class Kernel(BaseHTTPRequestHandler):
    """Gives the page and passes its messages on to the editors."""

    def __init__(self, editors, *request):
        self.editors = editors
        super().__init__(*request)

    def do_GET(self):
        widget = self.editors["one"].widget
        found = {
            "/": ("text/html", PAGE),
            "/editor.js": ("text/javascript", widget._esm),
            "/editor.css": ("text/css", widget._css),
            "/settings": ("application/json", json.dumps(widget.settings)),
        }
        self.reply(*found.get(self.path, ("image/x-icon", "")))

    def do_POST(self):
        message = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        sent = []

        class Shown:
            def send(self, *reply):
                sent.append(reply)

        self.editors[self.path[1:]]._hear(Shown(), message)
        ((content, buffers),) = sent
        encoded = base64.b64encode(buffers[0]).decode() if buffers else None
        self.reply("application/json", json.dumps({"content": content, "bytes": encoded}))

    def reply(self, kind, text):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.end_headers()
        self.wfile.write(str(text).encode())

    def log_message(self, format, *args):
        """Nothing."""


def test_the_kernel_hears_of_each_step(browse, cartoon):
    pytest.importorskip("anywidget", reason="needs the extra `notebook`")
    from toongeo import LandmarkEditor

    img = cartoon("moustache_man")[0]
    editors = {name: LandmarkEditor(img, TRUTH) for name in ("one", "two")}
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Kernel, editors))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    try:
        steps = [
            {"wait": "document.querySelectorAll('[data-ready]').length === 2"},
            {"run": DOUBLED_IDS},
            {"click": "#two [role=option] >> nth=8"},
            {"key": "ArrowDown", "on": "#two [role=listbox]"},
            {"key": "ArrowRight", "on": "#two [data-id=surface]"},
            {"wait": "document.querySelector('#two [data-id=count]').textContent === 'saved'"},
        ]  # fmt: skip
        report, _ = browse(f"http://127.0.0.1:{server.server_address[1]}/", steps)
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
    assert results(report) == [0] and report["console"] == []
    moved = TRUTH.copy()
    moved[9, 0] += 1
    np.testing.assert_allclose(editors["two"].landmarks, moved, atol=0.006)
    np.testing.assert_array_equal(editors["one"].landmarks, TRUTH)
