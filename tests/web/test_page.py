"""The page in a real browser: what moves, what does not, and whom it talks to (nobody)."""

import os
import shutil
import subprocess
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.conftest import ROOT
from toongeo.io import Scene, SceneMesh, encode_glb, page_html

READY = {"wait": "document.documentElement.dataset.ready === 'true'"}
PAGE = ROOT / "toongeo" / "io" / "page"
# Expression, and the eyeball that it uncovers or hides.
MOVES = {"eyeBlinkLeft": 0, "jawOpen": None, "browInnerUpRight": None, "mouthSmileLeft": None, "eyeLookUpRight": 1}
SEEN_MM = 0.02  # a tenth of a pixel of the pictures here


def picture(path):
    return cv2.imread(str(path)).astype(int)


def projection(points):
    """Steps that give the CSS pixels of points (k, 3) in mm."""
    return {"run": f"{(points / 1000).round(6).tolist()}.map((point) => toongeo.project(point))"}


def moved_points(avatar, name, side):
    """Where the vertices are, before and after, that an expression moves, and their eyeball."""
    weights = {name: 1.0}
    rest, moved = avatar.vertices(), avatar.vertices(weights)
    active = np.linalg.norm(moved - rest, axis=1) > SEEN_MM
    # The shading of a triangle changes with any of its corners, and of its neighbours with their normals.
    for _ in range(2):
        touched = avatar.faces[active[avatar.faces].any(axis=1)]
        active[touched] = True
    eyes = [] if side is None else [avatar.eye_vertices(side), avatar.eye_vertices(side, weights)]
    return np.vstack([rest[active], moved[active], *eyes])


@pytest.fixture(scope="module")
def visit(avatar, browse, tmp_path_factory):
    """One visit to the page of an avatar: pictures for each move, looks, and all that is clicked."""
    page = tmp_path_factory.mktemp("page") / "face.html"
    avatar.save(page, title="A face")
    steps = [READY, {"shot": "rest.png"}, {"shot": "again.png"}]
    for name, side in MOVES.items():
        points = moved_points(avatar, name, side)
        corners = np.array(np.meshgrid(*np.stack([points.min(0), points.max(0)], 1))).T.reshape(-1, 3)
        steps += [{"slider": name, "value": 1}, {"shot": f"{name}.png"}, projection(corners), {"click": "#reset"}]
    steps += [{"shot": "reset.png"}]
    for look in ("clay", "wire", "texture"):
        steps += [{"click": f"label:has(input[value={look}])"}, {"shot": f"{look}.png"}]
    steps += [
        {"key": "ArrowRight", "on": "#view"},
        {"shot": "turned.png"},
        {"key": "0", "on": "#view"},
        {"run": "document.activeElement.blur()"},  # else the ring of the focus is seen
        {"shot": "front.png"},
        {"click": "#presets button:text-is('Smile')"},
        {"shot": "smile.png"},
        {"run": "toongeo.weights()"},
        {"click": "#both"},
        {"slider": "eyeBlinkRight", "value": 0.5},
        {"run": "[toongeo.weights().eyeBlinkLeft, toongeo.weights().eyeBlinkRight]"},
        {"run": "toongeo.names"},
        {"run": "[...document.querySelectorAll('.slider input')].map((input) => input.name)"},
        {"download": "#shot", "file": "download.png"},
    ]
    report, folder = browse(page.as_uri(), steps)
    return report, folder, page


def test_nothing_is_loaded_and_nothing_complains(visit):
    report, _, page = visit
    assert report["console"] == []
    outside = [url for url in report["requests"] if not url.startswith("blob:")]
    assert outside == [page.as_uri()]


@pytest.mark.parametrize("name", MOVES)
def test_a_slider_moves_its_place_and_no_other(visit, name):
    report, folder, _ = visit
    changed = np.abs(picture(folder / f"{name}.png") - picture(folder / "rest.png")).max(axis=2) > 2
    assert changed.sum() > 100
    corners = np.array(report["results"][list(MOVES).index(name)])
    low, high = corners.min(0), corners.max(0)
    y, x = np.nonzero(changed)
    assert x.min() >= low[0] - 2 and x.max() <= high[0] + 2
    assert y.min() >= low[1] - 2 and y.max() <= high[1] + 2
    # And it is a part of the head that changes, not all of it.
    assert changed.mean() < 0.2


def test_the_same_weights_give_the_same_picture(visit):
    _, folder, _ = visit
    for same in ("again", "reset", "texture", "front"):
        np.testing.assert_array_equal(picture(folder / f"{same}.png"), picture(folder / "rest.png"), err_msg=same)


@pytest.mark.parametrize("other", ["clay", "wire", "turned", "smile"])
def test_looks_turns_and_presets_change_the_picture(visit, other):
    _, folder, _ = visit
    assert (np.abs(picture(folder / f"{other}.png") - picture(folder / "rest.png")) > 8).mean() > 0.004


def test_the_head_is_seen_as_the_library_draws_it(visit, avatar):
    """Silhouettes of two renderers: the page looks from near, the library from afar."""
    _, folder, _ = visit
    corner = picture(folder / "clay.png")
    head = np.abs(corner - corner[310, 5]).max(axis=2) > 40
    rows = np.flatnonzero(head[:, 150:420].sum(axis=1) > 20)
    assert 300 < np.ptp(rows) < 600


def test_presets_pairs_and_names(visit, avatar):
    report, _, _ = visit
    smile, both, names, sliders, _ = report["results"][len(MOVES) + 1 :]
    assert smile["mouthSmileLeft"] > 0.5 and smile["jawOpen"] < 0.5 and smile["eyeBlinkLeft"] == 0
    assert both == [0.5, 0.5]
    assert len(names) == 54 and sorted(sliders) == sorted(names) and set(avatar.names) < set(names)


def test_the_picture_is_saved_without_background(visit):
    report, folder, _ = visit
    assert report["results"][-1] == "A-face.png"
    saved = cv2.imread(str(folder / "download.png"), cv2.IMREAD_UNCHANGED)
    assert saved.shape[2] == 4 and saved[0, 0, 3] == 0 and (saved[:, :, 3] == 255).mean() > 0.1


EVIL = '"><script>window.hacked = 1</script><img src=x onerror="window.hacked = 2">'


def test_names_are_text_and_nothing_else(browse, tmp_path):
    up = {"targets": np.ones((2, 3, 3)), "target_names": (EVIL, "toString")}
    scene = Scene((SceneMesh(EVIL, 100 * np.eye(3), np.array([[0, 1, 2]]), **up),))
    page = tmp_path / "evil.html"
    page.write_text(page_html(encode_glb(scene), title=EVIL, presets={EVIL: {EVIL: 1.0}}), encoding="utf-8")
    report, _ = browse(
        page.as_uri(),
        [
            READY,
            {"click": "#presets button"},
            {"run": "[window.hacked ?? null, document.scripts.length, document.images.length, document.title]"},
            {"run": "[...document.querySelectorAll('.slider span')].map((label) => label.title)"},
            {"run": "toongeo.weights()[toongeo.names[0]]"},
        ],
    )
    assert report["results"] == [[None, 3, 0, EVIL], [EVIL, "toString"], 1]
    assert report["console"] == []


def test_a_switch_takes_the_hair_off(browse, tmp_path):
    """The page is as without hair while it is off, and as before when it is on again."""
    square = np.array([[-60.0, -60, 0], [60, -60, 0], [60, 60, 0], [-60, 60, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    head = SceneMesh("head", square, faces)
    hair = SceneMesh("hair", 0.5 * square + [0, 0, 20], faces, color=(0.6, 0.1, 0.1), double_sided=True, parent="head")
    visible = {"run": "document.getElementById('hair').checkVisibility()"}
    shots = []
    for name, meshes in (("with", (head, hair)), ("without", (head,))):
        page = tmp_path / f"{name}.html"
        page.write_text(page_html(encode_glb(Scene(meshes)), title=name), encoding="utf-8")
        steps = [READY, visible, {"shot": "a.png"}]
        if name == "with":
            steps += [{"click": "#hair"}, {"shot": "b.png"}, {"click": "#hair"}, {"shot": "c.png"}]
        report, folder = browse(page.as_uri(), steps)
        assert report["console"] == []
        assert report["results"] == [name == "with"]
        shots.append({path.stem: picture(path) for path in folder.glob("?.png")})
    worn, bare = shots
    np.testing.assert_array_equal(worn["a"], worn["c"])
    assert np.abs(worn["a"] - worn["b"]).max() > 50
    centre = tuple(slice(n // 2 - 20, n // 2 + 20) for n in bare["a"].shape[:2])
    assert np.abs(worn["b"][centre] - bare["a"][centre]).mean() < 3


def test_a_damaged_avatar_is_told(browse, tmp_path):
    page = tmp_path / "bad.html"
    page.write_text(page_html(b"glTF" + bytes(40), title="bad"), encoding="utf-8")
    wait = {"wait": "document.getElementById('status').classList.contains('wrong')"}
    report, _ = browse(page.as_uri(), [wait, {"run": "document.getElementById('status').textContent"}])
    assert report["results"][0].startswith("The avatar cannot be shown: ")


def test_the_page_is_escaped_and_sealed(tmp_path):
    page = page_html(b"glTF", title=EVIL, presets={EVIL: {"a": 1.0}})
    assert "<script>window.hacked" not in page and 'onerror="' not in page
    assert "default-src &#x27;none&#x27;" in page and "unsafe" not in page.split("<title>")[0]
    assert "Copyright © 2010-2026 three.js authors" in page and "The MIT License" in page
    with pytest.raises(ValueError, match="glb: expected the bytes of a .glb file, got b'PK'"):
        page_html(b"PK", title="zip")


def test_the_bundles_are_what_their_sources_give(tmp_path):
    """Rebuilt with the versions of package-lock.json, byte for byte."""
    npm = shutil.which("npm")
    required = os.environ.get("TOONGEO_REQUIRE_WEB") == "1"
    if not required and (npm is None or not (PAGE / "node_modules" / "esbuild").is_dir()):
        pytest.skip("run `npm ci --prefix toongeo/io/page` first")
    command = ["node", str(PAGE / "build.mjs"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    for bundle in ("viewer.js", "editor.js"):
        assert Path(tmp_path / bundle).read_bytes() == (PAGE / bundle).read_bytes(), bundle
