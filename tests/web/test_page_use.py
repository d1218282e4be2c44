"""The page in use: presets, life, takes, films, links, fingers and screen readers."""

import json

import cv2
import numpy as np
import pytest

from tests.web.test_page import READY, picture
from toongeo.io import Scene, SceneMesh, encode_glb, page_html
from toongeo.model.expression_schemes import SCHEMES

AT_REST = "Object.values(toongeo.weights()).every((weight) => weight === 0)"
# A target that is pressed by a finger: labels stand for the small boxes in them.
SMALL = """[...document.querySelectorAll('button, summary, #both, #looks label, #open, input[type=range], #find')]
  .filter((part) => part.checkVisibility())
  .map((part) => [part.textContent || part.name, part.getBoundingClientRect()])
  .filter(([, box]) => box.width < 43.9 || box.height < 43.9)
  .map(([text, box]) => [text.trim(), box.width, box.height])"""
OVER = """['header', '#bar', '#panel'].filter((name) => {
  const [a, b] = [name, '#view'].map((each) => document.querySelector(each).getBoundingClientRect());
  const width = Math.min(a.right, b.right) - Math.max(a.left, b.left);
  return width > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
})"""
SQUARE = """(() => {
  const [middle, up, right] = [[0, 0, 0], [0, 0.05, 0], [0.05, 0, 0]].map((point) => toongeo.project(point));
  return (right[0] - middle[0]) / (middle[1] - up[1]);
})()"""


def drop(name, text):
    """A file that is dropped on the page."""
    return {
        "run": f"""(() => {{
  const carried = new DataTransfer();
  carried.items.add(new File([{json.dumps(text)}], {json.dumps(name)}));
  document.dispatchEvent(new DragEvent('drop', {{ dataTransfer: carried, bubbles: true }}));
}})()"""
    }


STATUS = {"run": "document.getElementById('status').textContent"}


def live_link(seconds, fps=60):
    """Half a smile after a closed mouth, as Live Link Face writes it."""
    columns = list(SCHEMES["live_link"])
    rows = [
        f"10:00:{k // fps:02d}:{k % fps:02d}.123,61," + ",".join("0.5" if "Smile" in n else "0" for n in columns)
        for k in range(seconds * fps)
    ]
    return "\n".join([f"Timecode,BlendshapeCount,{','.join(columns)}", *rows])


@pytest.fixture(scope="module")
def page(avatar, tmp_path_factory):
    path = tmp_path_factory.mktemp("use") / "face.html"
    avatar.save(path, title="A face")
    return path


def test_presets_are_toggles_that_show_what_they_move(page, browse):
    pressed = {"run": "[...document.querySelectorAll('#presets [aria-pressed=true]')].map((each) => each.textContent)"}
    first = """(() => {
      const group = document.querySelector('#sliders details:not([hidden])');
      const inputs = [...group.querySelectorAll('input')];
      const box = inputs.at(-1).getBoundingClientRect();
      return [group.querySelector('summary').textContent, inputs.map((input) => input.name), box.bottom <= innerHeight];
    })()"""
    smile, anger = (f"#presets button:text-is('{name}')" for name in ("Smile", "Anger"))
    steps = [READY, {"size": [1280, 800]}, pressed, {"run": first}]
    steps += [{"click": smile}, pressed, {"run": first}, {"axe": "document"}]
    steps += [{"click": anger}, pressed, {"run": "toongeo.weights().mouthSmileLeft"}, {"click": anger}, pressed]
    steps += [{"run": AT_REST}, {"run": first}, {"axe": "document"}]
    steps += [{"run": "document.body.innerText.match(/subject's/g).length"}]
    report, _ = browse(page.as_uri(), steps)
    before, shown, on, moves, violations, other, smiling, off, rest, again, at_rest, said = report["results"]
    assert before == [] and on == ["Smile"] and other == ["Anger"] and off == []
    assert shown[0].startswith("Mouth") and again == shown
    assert moves[0] == "Smile moves (8)" and moves[2]  # all of them are seen at once
    assert "mouthSmileLeft" in moves[1] and "cheekSquintRight" in moves[1]
    assert smiling == 0 and rest is True
    assert violations == at_rest == [] and said == 1
    assert report["console"] == []


def test_it_lives_unless_motion_is_not_wanted(page, browse):
    """Wishes of the system count, and so does the switch; weights that are set stay what they are."""
    alive = {"run": "document.getElementById('idle').getAttribute('aria-pressed')"}
    seen = {"run": "new Promise((done) => setTimeout(done, 600))"}
    steps = [READY, alive, {"shot": "calm.png"}, {"media": {"reducedMotion": "no-preference"}}]
    steps += [{"wait": f"{alive['run']} === 'true'"}, alive]
    steps += [seen, {"shot": "a.png"}, seen, {"shot": "b.png"}, {"run": AT_REST}]
    steps += [{"click": "#idle"}, alive, {"shot": "off.png"}]
    report, folder = browse(page.as_uri(), steps)
    calm, wanted, _, _, rest, off = report["results"]
    assert (calm, wanted, off, rest) == ("false", "true", "false", True)
    first, a, b, last = (picture(folder / f"{name}.png") for name in ("calm", "a", "b", "off"))
    # The button that is pressed is seen too: the head alone is compared.
    head = np.s_[80:480, 100:460]
    np.testing.assert_array_equal(first[head], last[head])
    assert (a[head] != b[head]).any() and (a[head] != first[head]).any()


TAKES = [
    (live_link(50), "Playing 0.csv: 3000 frames, 50.0 s", {"mouthSmileLeft": 0.5, "jawOpen": 0}),
    ("\ufefftime;jawOpen\r\n0;0,25\r\n0,5;\r\n90;0,25\r\n", "3 frames, 90.0 s", {"jawOpen": 0.25}),
    ("time,browInnerUp\n0,40\n90,40\n", "2 frames, 90.0 s", {"browInnerUpLeft": 0.4, "browInnerUpRight": 0.4}),
    ("name,age\nAda,36\n", "3.csv cannot be played: no column is named like an expression", {}),
    ("time,jawOpen\n1,0\n1,0\n", "4.csv cannot be played: its times do not grow", {}),
    ("time,jawOpen\n", "5.csv cannot be played: it has no frames", {}),
]


def test_takes_that_are_dropped_play(glb_page, browse):
    pressed = "document.getElementById('play').getAttribute('aria-pressed')"
    frames = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
    steps = [READY]
    for k, (text, _, peak) in enumerate(TAKES):
        told = {"wait": f"document.getElementById('status').textContent.includes('{k}.csv')"}
        steps += [drop(f"{k}.csv", text), told, STATUS, {"run": pressed}]
        if peak:
            steps += [
                {"run": f"{frames}.then(toongeo.weights)"},
                {"click": "#play"},
                {"run": AT_REST},
                {"run": pressed},
            ]
    report, _ = browse(glb_page.as_uri(), steps)
    found = iter(report["results"])
    for _, told, peak in TAKES:
        next(found)
        assert told in next(found)
        assert next(found) == ("true" if peak else "false")
        if peak:
            weights = next(found)
            assert {name: weights[name] for name in peak} == pytest.approx(peak, abs=0.02)
            assert [next(found), next(found)] == [True, "false"]
    assert report["console"] == []


@pytest.fixture(scope="module")
def glb_page(tmp_path_factory):
    """A page that loads at once: a triangle with some of the names."""
    names = ("jawOpen", "mouthSmileLeft", "mouthSmileRight", "browInnerUpLeft", "browInnerUpRight", "eyeBlinkLeft")
    targets = np.ones((len(names), 3, 3))
    mesh = SceneMesh("head", 100 * np.eye(3), np.array([[0, 1, 2]]), targets=targets, target_names=names)
    page = tmp_path_factory.mktemp("small") / "small.html"
    page.write_text(page_html(encode_glb(Scene((mesh,))), title="small"), encoding="utf-8")
    return page


def test_a_link_shows_the_same_expression(glb_page, browse):
    copied = "window.copied = ''; navigator.clipboard.writeText = async (text) => { window.copied = text; }; 0"
    steps = [READY, {"run": copied}, {"slider": "jawOpen", "value": 0.37}, {"slider": "eyeBlinkLeft", "value": 1}]
    steps += [{"click": "#link"}, STATUS, {"run": "window.copied"}]
    report, _ = browse(glb_page.as_uri(), steps)
    _, told, address = report["results"]
    assert told == "The link is copied." and address == f"{glb_page.as_uri()}#w=jawOpen:0.37,eyeBlinkLeft:1"
    shown = {"run": "[toongeo.weights(), document.querySelector('input[name=jawOpen]').value]"}
    evil = "#w=constructor:1,jawOpen:9,%E0%A4:1,mouthSmileLeft:0.5,eyeBlinkLeft"
    report, _ = browse(
        address,
        [READY, shown, {"run": f"location.hash = {evil!r}; 0"}, {"wait": "toongeo.weights().jawOpen === 0"}, shown],
    )
    (first, slider), _, (other, _) = report["results"]
    assert (first["jawOpen"], first["eyeBlinkLeft"], slider) == (0.37, 1, "0.37")
    assert {name: weight for name, weight in other.items() if weight} == {"mouthSmileLeft": 0.5}


def test_a_film_is_recorded(glb_page, browse):
    steps = [READY, {"click": "#film"}, {"click": "#turn"}, {"run": "new Promise((done) => setTimeout(done, 500))"}]
    report, folder = browse(glb_page.as_uri(), [*steps, {"download": "#film", "file": "film.webm"}])
    assert report["results"][-1] == "small.webm"
    film = cv2.VideoCapture(str(folder / "film.webm"))
    assert (folder / "film.webm").read_bytes()[:4] == b"\x1a\x45\xdf\xa3" and film.read()[0]
    assert report["console"] == []


def test_it_works_on_a_phone_in_both_orientations(page, browse):
    """Targets for fingers, nothing over the head, a sheet that folds, and nothing that a screen reader misses."""
    settled = "new Promise((done) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), 300))"
    look = [{"run": settled}, {"run": SMALL}, {"run": OVER}, {"run": SQUARE}, {"axe": "document"}]
    wide = {"run": "document.documentElement.scrollWidth <= innerWidth"}
    open_ = {"run": "document.getElementById('sheet').getAttribute('aria-expanded')"}
    steps = [{"size": [390, 844]}, READY, open_, *look, wide, {"click": "#sheet"}, open_, *look]
    steps += [{"key": "Escape", "on": "#find"}, open_, {"run": "document.activeElement.id"}, {"click": "#sheet"}]
    steps += [{"size": [844, 390]}, {"run": "new Promise((done) => setTimeout(done, 200))"}, *look, wide]
    steps += [{"click": "#sheet"}, *look, {"size": [900, 620]}, {"run": "new Promise((done) => setTimeout(done, 200))"}]
    steps += [{"run": "document.getElementById('sliders').checkVisibility()"}]
    report, _ = browse(page.as_uri(), steps)
    found = iter(report["results"])

    def looked():
        _, small, over, square, violations = (next(found) for _ in look)
        assert small == [] and over == [] and violations == []
        assert square == pytest.approx(1, abs=0.05)  # a head is as high as it should be for its width

    assert next(found) in ("true", "false")  # as the window was when it was opened
    looked()
    assert next(found) is True
    assert next(found) in ("true", "false")
    looked()
    assert next(found) == "false" and next(found) == "sheet"
    next(found)
    looked()
    assert next(found) is True
    looked()
    next(found)
    assert next(found) is True  # a wide window has all of it, folded or not
    assert report["console"] == []


def test_the_first_frame_does_not_wait_for_the_rest(page, browse):
    """It is drawn before the shading of expressions is computed."""
    report, _ = browse(
        page.as_uri(), [READY, {"run": "[Number(document.documentElement.dataset.first), performance.now()]"}]
    )
    ((first, ready),) = report["results"]
    assert 0 < first < ready
