"""The landmark editor by keyboard, by fingers, by screen reader, on a desktop and on a phone."""

import cv2
import numpy as np
import pytest

from tests.app.editor.serving import serving
from tests.web.editing import POINTS, READY, SCALE, SELECTED, TRUTH, a_picture, at, button, found, press, results, text
from toongeo.io import write_landmarks
from toongeo.model.ibug68 import PARTS

pytestmark = pytest.mark.slow

INSIDE = """[...document.querySelectorAll('.top button, .top select, .bar button')]
  .filter((part) => part.offsetParent)
  .map((part) => part.getBoundingClientRect())
  .every((box) => box.left >= 0 && box.right <= innerWidth && box.bottom <= innerHeight)"""
TYPE_X = """(() => {
  const x = document.querySelector('[data-id=x]');
  x.value = '12.5';
  x.dispatchEvent(new Event('change'));
})()"""


def test_keys_and_numbers(tmp_path, browse):
    write_landmarks(a_picture(tmp_path) / "face.csv", TRUTH)
    brow, points = PARTS["brow_right"], "[role=listbox]"
    with serving(tmp_path) as server:
        steps = [
            READY,
            SCALE,
            {"run": f"toongeo.select({brow.tolist()})"},
            *map(press, ["ArrowRight", "ArrowRight", "Shift+ArrowUp", "Alt+ArrowLeft"]),
            POINTS,
            press("Control+z"),
            POINTS,
            press("Escape"),
            press("n"),
            {"run": f"[toongeo.selection(), {text('chosen')}]"},
            press("+"),
            SCALE,
            press("0"),
            SCALE,
            # The list of points: down two, then type a place.
            press("ArrowDown", points),
            press("ArrowDown", points),
            SELECTED,
            {"run": f"document.querySelector('{points}').getAttribute('aria-activedescendant')"},
            {"run": TYPE_X},
            {"run": "toongeo.points()[2]"},
        ]
        report, _ = browse(server.url, steps)
    fitted, nudged, undone, walked, nearer, again, listed, active, typed = results(report)
    step = np.zeros((68, 2))
    step[brow] = [1.9, -10]
    np.testing.assert_allclose(nudged, TRUTH + step, atol=0.006)
    np.testing.assert_array_equal(undone, TRUTH)  # nudges of the same points are one step
    assert walked == [[0], "0 · Jaw right ear"]
    assert nearer > 1.2 * fitted and again == fitted
    assert listed == [2] and active.endswith("-2")
    np.testing.assert_allclose(typed, [12.5, TRUTH[2, 1]], atol=0.006)


def test_fingers(tmp_path, browse):
    """One finger drags a point, two zoom; a second finger takes a drag back."""
    write_landmarks(a_picture(tmp_path) / "face.csv", TRUTH)
    drag = "[0, 1, 2, 3].map((t) => [toongeo.screen(30).map((v, i) => v + [8, 6][i] * t)])"
    spread = "[0, 1, 2, 3].map((t) => [[150 - 12 * t, 250], [250 + 12 * t, 250]])"
    chin, away = at(8), "toongeo.screen(8).map((v, i) => v + [30, 0][i])"
    taken = f"[[{chin}], [{away}], [{away}, [60, 200]]]"
    with serving(tmp_path) as server:
        steps = [{"size": [390, 844]}, READY, SCALE, {"touch": drag}, POINTS]
        steps += [{"touch": taken}, POINTS, {"touch": spread}, SCALE]
        report, _ = browse(server.url, steps)
    scale, dragged, kept, nearer = results(report)
    np.testing.assert_allclose(dragged[30], TRUTH[30] + np.array([24, 18]) / scale, atol=0.02)
    np.testing.assert_array_equal(np.delete(dragged, 30, 0), np.delete(TRUTH, 30, 0))
    np.testing.assert_array_equal(kept, dragged)
    np.testing.assert_allclose(nearer / scale, 172 / 100, rtol=0.02)


@pytest.mark.parametrize("size", [[1280, 800], [390, 844]], ids=["desktop", "phone"])
def test_everyone_can_use_it(tmp_path, browse, size):
    """No violation of axe's rules, in any state; nothing is cut off; what is drawn is seen."""
    a_picture(tmp_path)
    rules = {"axe": "document"}
    asking = [button("clicks"), rules, button("cancel"), press("?"), rules, {"click": "dialog button"}]
    with serving(tmp_path, found) as server:
        steps = [
            {"size": size},
            READY,
            {"page": "found.png"},
            {"run": "toongeo.select([30])"},
            button("soft"),
            button("fitted"),
            rules,
            *(asking if size[0] > 1000 else []),
            {"run": "document.documentElement.scrollWidth - innerWidth"},
            {"run": INSIDE},
            {"run": at(33)},
        ]
        report, folder = browse(server.url, steps)
    *violations, wider, inside, nose = results(report)
    assert violations and not any(violations), violations
    assert wider <= 0 and inside
    x, y = np.round(nose).astype(int)
    blue, green, red = cv2.imread(str(folder / "found.png"))[y, x]
    assert green > red and green > blue  # a sure point
