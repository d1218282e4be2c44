"""An avatar in the player TalkingHead: it loads, idles, looks about and opens each viseme."""

import cv2
import numpy as np
import pytest

from toongeo.model.expression_schemes import SCHEMES

READY = {"wait": "window.state !== 'loading'"}
VISEMES = ("aa", "E", "I", "O", "U", "PP", "SS", "TH", "DD", "FF", "kk", "nn", "RR", "CH")  # sil moves nothing
LOOKS = ("eyesLookUp", "eyeLookInLeft", "eyeBlinkRight", "mouthSmile", "jawOpen")
OBJECTS = ["LeftEye", "RightEye", "EyeLeft", "EyeRight", "LeftToeBase", "LeftHand", "LeftArm", "Wolf3D_Head"]


@pytest.fixture(scope="module")
def visit(avatar, browse, serve, tmp_path_factory):
    folder = tmp_path_factory.mktemp("player")
    avatar.save(folder / "face.glb", names="talkinghead")
    with serve(folder) as site:
        steps = [
            READY,
            {"run": "window.state"},
            {"run": f"places({OBJECTS})"},
            {"run": "play(4000)"},
            {"run": f"places({OBJECTS})"},
            {"run": "draw()"},
            {"shot": "rest.png"},
            *({"run": f"held('viseme_{name}')"} for name in VISEMES),
            {"run": "held('viseme_sil')"},
            *({"run": f"held('{name}')"} for name in LOOKS),
            {"run": "play(1000)"},
            {"run": "spoken(['U', 'PP', 'O', 'FF'], 250)"},
            {"run": "Object.keys(head.mtAvatar)"},
        ]
        report, pictures = browse(f"{site}/talkinghead.html?face.glb", steps)
    return report, pictures, site


def results(report, start, count):
    """Of the runs from one on, after those that come before all visemes."""
    return report["results"][4 + start :][:count]


def test_the_player_takes_it(visit):
    report, _, site = visit
    assert report["results"][0] == "ready"
    assert report["console"] == []
    outside = [url for url in report["requests"] if not url.startswith((site, "blob:", "data:"))]
    assert outside == []


def test_the_body_carries_the_head(visit):
    """Eyes of the body in those of the face, feet on the ground, hands hang down; and it never stands still."""
    report, _, _ = visit
    before, after = (dict(zip(OBJECTS, np.array(report["results"][k]), strict=True)) for k in (1, 3))
    for places in (before, after):
        np.testing.assert_allclose(places["LeftEye"], places["EyeLeft"], atol=1e-6)
        np.testing.assert_allclose(places["RightEye"], places["EyeRight"], atol=1e-6)
        assert 1.4 < places["LeftEye"][1] < 1.8
        assert abs(places["LeftToeBase"][1]) < 0.15
        assert places["LeftHand"][1] < places["LeftArm"][1] - 0.2
    assert not np.allclose(before["Wolf3D_Head"], after["Wolf3D_Head"], atol=1e-4)


def test_each_viseme_opens(visit):
    report, _, _ = visit
    *held, (_, still) = results(report, 1, len(VISEMES) + 1)
    metres = {}
    for name, (influence, moved) in zip(VISEMES, held, strict=True):
        assert influence > 0.8, name
        metres[name] = moved
    assert still == 0
    assert min(metres.values()) > 5e-4, metres
    assert metres["aa"] > 2 * metres["PP"]


def test_it_looks_blinks_and_smiles(visit):
    report, _, _ = visit
    for name, (influence, metres) in zip(LOOKS, results(report, 2 + len(VISEMES), len(LOOKS)), strict=True):
        assert influence > 0.8 and metres > 5e-4, name


def test_it_speaks(visit):
    report, _, _ = visit
    (spoken,) = results(report, 3 + len(VISEMES) + len(LOOKS), 1)
    assert all(most > 0.3 for most in spoken.values()), spoken


def test_it_has_all_that_the_player_knows(visit):
    report, _, _ = visit
    assert set(report["results"][-1]) >= {*SCHEMES["arkit"], *(f"viseme_{name}" for name in VISEMES)}


def test_it_is_seen(visit):
    _, pictures, _ = visit
    picture = cv2.imread(str(pictures / "rest.png")).astype(int)
    seen = np.abs(picture - picture[2, 2]).max(axis=2) > 20
    assert 0.05 < seen.mean() < 0.8 and seen[140:180, 140:180].mean() > 0.8  # it sways
