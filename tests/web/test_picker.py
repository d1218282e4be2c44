"""The landmark picker in a real browser: by mouse, keys and fingers, on a desktop and on a phone."""

import json
import threading
from contextlib import contextmanager

import cv2
import numpy as np
import pytest

from tests.web.editing import button, results, says, text
from toongeo.app.editor.editor_server import EditorServer
from toongeo.app.picker.picked_mesh import PickedMesh
from toongeo.app.picker.picker_session import PickerSession
from toongeo.io import read_mesh_landmarks
from toongeo.model.ibug68 import MIRROR

pytestmark = pytest.mark.slow

READY = {"wait": "document.querySelector('[data-ready]')"}
VERTICES, PROPOSED, CURRENT = ({"run": f"toongeo.{name}()"} for name in ("vertices", "proposed", "current"))
CANVAS = "[data-id=canvas]"
TYPE = """(() => {
  const field = document.querySelector('[data-id=vertex]');
  field.value = '%s';
  field.dispatchEvent(new Event('change'));
})()"""
INSIDE = """[...document.querySelectorAll('.top button, .top select, .ask button')]
  .map((part) => part.getBoundingClientRect())
  .every((box) => box.left >= 0 && box.right <= innerWidth && box.bottom <= innerHeight)"""


@contextmanager
def serving(model, output, *, mirror=True, **options):
    mesh = PickedMesh(model.mean, model.faces, mirror=model.mirror if mirror else None)
    with EditorServer(PickerSession(mesh, "head.obj", output, **options)) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


def click(vertex):
    return {"tap": f"toongeo.screen({vertex})"}


def test_click_propose_remove_undo_save(tmp_path, browse, model):
    """The way of a user: the clicked vertices are the template's landmarks, and the file holds them."""
    table = model.landmarks.tolist()
    clicked = [36, 37, 38, 39, 40, 41, 27, 28]
    with serving(model, tmp_path / "head.json") as server:
        steps = [
            READY,
            CURRENT,
            {"run": text("what")},
            *(click(table[k]) for k in clicked[:6]),
            CURRENT,  # the other eye is proposed, so the nose is next
            click(table[27]),
            click(table[28]),
            VERTICES,
            PROPOSED,
            {"run": "toongeo.select(36)"},
            button("remove"),
            VERTICES,
            button("undo"),
            VERTICES,
            # A proposal is corrected, and its model stays as it was.
            {"run": "toongeo.select(42)"},
            {"run": TYPE % 17},
            VERTICES,
            {"key": "Control+z", "on": CANVAS},
            {"drag": f"toongeo.screen({table[30]})", "by": [90, 20]},  # a turn, no click
            VERTICES,
            {"run": text("count")},
            button("save"),
            says("status", "Saved head.json"),
            {"run": text("count")},
        ]
        report, _ = browse(server.url, steps)
        origin = server.url.partition("?")[0]
    first, what, after, some, proposed, without, undone, corrected, turned, before, saved = results(report)
    assert (first, what, after) == (36, "36 · Eye right outer corner", 27)
    twins = [int(MIRROR[k]) for k in clicked]
    expected = [
        table[k] if k in clicked else int(model.mirror[table[MIRROR[k]]]) if k in twins else None for k in range(68)
    ]
    assert some == expected
    assert [k for k in range(68) if proposed[k]] == sorted(set(twins) - set(clicked))
    assert without == [None if k in (36, 45) else vertex for k, vertex in enumerate(expected)]
    assert undone == expected and turned == expected
    assert corrected == [17 if k == 42 else vertex for k, vertex in enumerate(expected)]
    assert before == "14 of 68 · 6 of them proposed · not saved" and saved == "14 of 68 · 6 of them proposed"
    assert json.loads((tmp_path / "head.json").read_text()) == expected
    points = read_mesh_landmarks(tmp_path / "head.json", model.mean)
    np.testing.assert_array_equal(points[36], model.mean[table[36]])
    assert report["console"] == [] and all(url.startswith((origin, "data:")) for url in report["requests"])


def test_by_keys_alone(tmp_path, browse, model):
    """The head is turned, a crosshair is moved, the list is walked through; what lies beneath the crosshair is set."""
    (tmp_path / "head.json").write_text("{}")
    aim = ["Shift+ArrowRight"] * 2 + ["Shift+ArrowUp", "Alt+Shift+ArrowLeft"]
    cross = "document.querySelector('[data-id=cross]').getBoundingClientRect()"
    with serving(model, tmp_path / "head.json", mirror=False) as server:
        steps = [
            READY,
            {"run": text("status")},
            {"run": "toongeo.screen(0)"},
            {"key": "ArrowLeft", "on": CANVAS},
            {"run": "toongeo.screen(0)"},
            *({"key": key, "on": CANVAS} for key in aim),
            {"run": f"(({{ x, y, width }}) => [x + width / 2, y + width / 2])({cross})"},
            {"key": "Enter", "on": CANVAS},
            VERTICES,
            {"run": "toongeo.screen(toongeo.vertices()[36])"},
            {"key": "n", "on": CANVAS},
            {"key": "p", "on": CANVAS},
            CURRENT,
            {"key": "ArrowDown", "on": "[role=listbox]"},
            CURRENT,
            {"key": "Control+s", "on": CANVAS},
            {"wait": "document.querySelector('dialog').open"},
            {"run": text("words")},
            {"click": "dialog button.main"},
            says("status", "Saved head.json, 67 points missing"),
        ]
        report, _ = browse(server.url, steps)
    note, rest, turned, aimed, vertices, found, back, below, asked = results(report)
    assert "expected a list of 68 entries" in note
    assert np.linalg.norm(np.subtract(rest, turned)) > 1
    assert sum(vertex is not None for vertex in vertices) == 1 and vertices[36] is not None
    assert np.linalg.norm(np.subtract(found, aimed)) < 12  # of a corner of the triangle beneath
    assert (back, below) == (37, 38) and asked == "head.json is there already. Replace it?"
    assert json.loads((tmp_path / "head.json").read_text()) == vertices


def test_fingers_on_a_phone(tmp_path, browse, model):
    """A tap picks, one finger turns, two pick nothing."""
    nose = f"toongeo.screen({int(model.landmarks[30])})"
    two = f"[[{nose}, [60, 200]], [{nose}, [40, 200]]]"
    with serving(model, tmp_path / "head.json") as server:
        steps = [{"size": [390, 844]}, READY, {"run": "toongeo.select(30)"}, {"touch": two}, VERTICES]
        steps += [{"touch": f"[0, 1, 2].map((t) => [{nose}.map((v, i) => v + [20, 4][i] * t)])"}, VERTICES]
        steps += [{"touch": f"[[{nose}]]"}, VERTICES]
        report, _ = browse(server.url, steps)
    pinched, turned, tapped = results(report)
    assert pinched == turned == [None] * 68
    assert tapped[30] == model.landmarks[30]


@pytest.mark.parametrize("size", [[1280, 800], [390, 844]], ids=["desktop", "phone"])
def test_everyone_can_use_it(tmp_path, browse, model, size):
    """No violation of axe's rules, light or dark; nothing is cut off; picked points are seen on the mesh."""
    table = model.landmarks.tolist()
    (tmp_path / "start.json").write_text(json.dumps(table))
    rules = {"axe": "document"}
    with serving(model, tmp_path / "head.json", start=tmp_path / "start.json") as server:
        steps = [
            {"size": size},
            READY,
            {"run": "toongeo.select(8)"},
            rules,
            {"media": {"colorScheme": "dark"}},
            rules,
            {"key": "?", "on": CANVAS},
            rules,
            {"click": "dialog button"},
            {"page": "picked.png"},
            {"run": "document.documentElement.scrollWidth - innerWidth"},
            {"run": INSIDE},
            {"run": f"toongeo.screen({table[30]})"},
        ]
        report, folder = browse(server.url, steps)
    *violations, wider, inside, nose = results(report)
    assert len(violations) == 3 and not any(violations), violations
    assert wider <= 0 and inside
    x, y = np.round(nose).astype(int)
    blue, _, red = cv2.imread(str(folder / "picked.png"))[y, x].astype(int)
    assert blue > red + 60  # a picked point
