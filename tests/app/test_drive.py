"""A take on an avatar: as a video that plays back, as a GLB that three.js plays."""

import csv
import json
import os
import re
import wave
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.driving.conftest import film, rms
from toongeo.app.cli import main
from toongeo.app.read_take import read_landmark_take, read_take
from toongeo.app.video import write_video as video
from toongeo.app.video.actor_pictures import with_actor
from toongeo.app.video.film_frames import film_frames
from toongeo.app.video.sound import Sound
from toongeo.app.video.write_film import _Drawing
from toongeo.app.video.write_video import write_video
from toongeo.avatar import load_avatar
from toongeo.driving import AvatarPuppet, ScenePuppet, Take, head_quaternions, write_live_link
from toongeo.io import Scene, SceneMesh, glb_scene, read_glb, read_video, write_glb
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

LIVE_LINK = tuple(SCHEMES["live_link"])


@pytest.fixture(scope="module")
def glb(avatar, tmp_path_factory):
    path = tmp_path_factory.mktemp("drive") / "face.glb"
    avatar.save(path)
    return path


@pytest.fixture
def take(tmp_path):
    """Half a second in which the jaw opens, at 30 frames a second."""
    path = tmp_path / "take.csv"
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["Timecode", "BlendshapeCount", *LIVE_LINK])
        for i in range(16):
            code = f"10:00:{(i + 15) // 30:02d}:{(i + 15) % 30:02d}.000"
            writer.writerow([code, 61, *(i / 15 if name == "JawOpen" else 0.0 for name in LIVE_LINK)])
    return path


def played(path):
    video = cv2.VideoCapture(str(path))
    frames = []
    while (read := video.read())[0]:
        frames.append(read[1][:, :, ::-1])
    return np.array(frames), video.get(cv2.CAP_PROP_FPS)


def test_a_video_shows_the_take(glb, take, avatar, tmp_path, capsys):
    out = tmp_path / "take.mp4"
    assert main(["drive", str(glb), "--weights", str(take), "-o", str(out), "--size", "128", "--fps", "10"]) == 0
    frames, fps = played(out)
    assert frames.shape == (6, 128, 128, 3) and fps == 10
    for k, frame in enumerate(frames):
        wanted = avatar.render({"jawOpen": k / 5}, size=128).astype(float)
        errors = [np.abs(frame - avatar.render({"jawOpen": j / 5}, size=128).astype(float)).mean() for j in range(6)]
        assert int(np.argmin(errors)) == k and np.abs(frame - wanted).mean() < 8
    assert f"wrote {out}: 6 frames, 0.50 s" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["take.csv", "take.mp4"]


def test_a_glb_plays_the_take(glb, take, tmp_path, node):
    out = tmp_path / "take.glb"
    assert main(["drive", str(glb), "--weights", str(take), "-o", str(out)]) == 0
    (verdict,) = node("validate.mjs", out)
    assert verdict["errors"] == verdict["warnings"] == 0
    (report,) = node("load.mjs", out)
    (clip,) = report["animations"]
    assert clip["duration"] == pytest.approx(0.5, abs=1e-5)
    head = next(mesh for mesh in report["meshes"] if mesh["name"] == "head")
    halfway = clip["halfway"][report["meshes"].index(head)]
    assert halfway[head["targets"].index("jawOpen")] == pytest.approx(0.5, abs=1e-4)
    assert sum(map(abs, halfway)) == pytest.approx(0.5, abs=1e-4)


@pytest.mark.parametrize("options", [{"names": "arkit"}, {"crop": "face"}, {"loadable": False}])
def test_any_glb_with_named_targets_can_be_driven(avatar, take, tmp_path, options):
    """Renamed, cut out, or without what is needed to load it: what moves are the targets, by their names."""
    source, out = tmp_path / "face.glb", tmp_path / "out.glb"
    avatar.save(source, **options)
    assert main(["drive", str(source), "--weights", str(take), "-o", str(out)]) == 0
    before, after = glb_scene(read_glb(source)), glb_scene(read_glb(out))
    (head,) = (mesh for mesh in after.meshes if mesh.name == "head")
    weights = after.animation.weights["head"]
    np.testing.assert_allclose(weights[:, head.target_names.index("jawOpen")], np.linspace(0, 1, 16), atol=1e-6)
    assert np.count_nonzero(weights) == 15
    np.testing.assert_array_equal(before.meshes[0].vertices, after.meshes[0].vertices)
    film = tmp_path / "out.mp4"
    assert main(["drive", str(source), "--weights", str(take), "-o", str(film), "--size", "64", "--fps", "10"]) == 0
    frames, _ = played(film)
    puppet = ScenePuppet(after, 64)
    for k, frame in enumerate(frames):
        errors = [np.abs(frame - puppet.frame({"jawOpen": j / 5}).astype(float)).mean() for j in range(6)]
        assert int(np.argmin(errors)) == k


def test_a_glb_without_expressions_is_told(tmp_path, take, capsys):
    mesh = SceneMesh("box", np.eye(3), np.array([[0, 1, 2]]), targets=np.ones((1, 3, 3)), target_names=("Basis",))
    write_glb(tmp_path / "box.glb", Scene((mesh,)))
    arguments = ["drive", str(tmp_path / "box.glb"), "--weights", str(take), "-o", str(tmp_path / "out.glb")]
    assert main(arguments) == 2
    assert "box.glb: targets: expected names of ARKit's expressions, got Basis" in capsys.readouterr().err
    assert not (tmp_path / "out.glb").exists()


def test_landmarks_of_another_face_drive(glb, avatar, tmp_path):
    weights = np.zeros((12, 46))
    weights[:, avatar.names.index("jawOpen")] = np.linspace(0, 0.8, 12)
    np.save(tmp_path / "points.npy", film(avatar, weights))
    out = tmp_path / "take.mp4"
    arguments = ["--landmarks", str(tmp_path / "points.npy"), "-o", str(out), "--size", "64"]
    assert main(["drive", str(glb), *arguments]) == 0
    frames, _ = played(out)
    last = avatar.render({"jawOpen": 0.8}, size=64).astype(float)
    assert len(frames) == 12
    assert np.abs(frames[-1] - last).mean() < np.abs(frames[0] - last).mean()


def test_arrays_of_weights(tmp_path):
    own, arkit = tmp_path / "own.npy", tmp_path / "arkit.npy"
    np.save(own, np.eye(54)[:3])
    np.save(arkit, np.eye(52)[:3])
    np.testing.assert_array_equal(read_take(own).weights, np.eye(54)[:3])
    wanted = [EXPRESSIONS.index(name) for name in list(SCHEMES["arkit"])[:3]]
    np.testing.assert_array_equal(read_take(arkit, 10).weights, np.eye(54)[wanted])
    np.testing.assert_allclose(read_take(arkit, 10).times, [0, 0.1, 0.2])
    np.save(own, 80.0 * np.eye(54)[:3])
    np.testing.assert_allclose(read_take(own).weights, 0.8 * np.eye(54)[:3])
    assert read_take(own).notes == ("weights of up to 80 were taken for percent",)


def test_frames_of_landmarks_without_a_face_are_held(tmp_path, avatar):
    weights = np.zeros((8, 46))
    weights[:, avatar.names.index("jawOpen")] = 0.5 * np.sin(np.arange(8))
    points = film(avatar, weights)
    path = tmp_path / "points.npy"
    lost = points.copy()
    lost[[0, 5]] = np.nan
    np.save(path, lost)
    expected = read_landmark_take(path)
    lost[[0, 5]] = 0.0  # as programs write a face that they did not see
    np.save(path, lost)
    take = read_landmark_take(path)
    np.testing.assert_array_equal(take.weights, expected.weights)
    assert take.notes == expected.notes == ("2 of 8 frames show no face and were held",)
    np.save(path, np.zeros((3, 68, 2)))
    with pytest.raises(ValueError, match="points.npy: expected a face in at least one frame, got none in 3"):
        read_landmark_take(path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"--weights": "none.csv"}, "none.csv"),
        ({"--weights": "broken.csv"}, "expected columns named like ARKit's expressions, got Jaw"),
        (
            {"--weights": "broken.npy"},
            "--weights: expected an array of numbers in NumPy's format, but broken.npy is damaged",
        ),
        ({"--weights": "take.txt"}, "weights: expected a .csv or .npy file"),
        ({"-o": "take.avi"}, "output: expected a name that ends in .mp4, .webm, .glb, .csv"),
        ({"-o": "no/take.mp4"}, "output: no folder"),
        ({"-o": "folder.mp4"}, "it is a folder"),
        ({"-o": "folder.glb"}, "folder.glb"),
        ({"--size": "33"}, "size: expected an even number of px"),
        ({"--fps": "0"}, "fps: expected 1 to 240"),
        ({"--fps": "0", "-o": "out.glb"}, "fps: expected a rate > 0"),
        ({"--size": "100000"}, "size: expected at most as many pixels as 5792 x 5792, got 100000 x 100000"),
        ({"--processes": "0"}, "processes: expected 1 to 61, got 0"),
        ({"--processes": "999999"}, "processes: expected 1 to 61, got 999999"),
        ({"--start": "3"}, "start, end: expected a frame between 3.0 and None s, got none (the take is 0.50 s long)"),
        ({"--actor": "corner"}, "actor: expected a film of an actor (video) to show, got none"),
        ({"--sound": "take.csv"}, "sound: expected a file with a sound, got take.csv"),
        ({"--fps": "500"}, "fps: expected 1 to 240"),
        ({"avatar": "none.glb"}, "none.glb"),
        ({"avatar": "cut.glb"}, "cut.glb is damaged or none"),
    ],
)
def test_bad_input_is_one_line_and_no_file(glb, take, tmp_path, monkeypatch, capsys, change, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "broken.csv").write_text("Jaw\n0\n")
    (tmp_path / "broken.npy").write_bytes(b"\x93NUMPY broken")
    (tmp_path / "cut.glb").write_bytes(glb.read_bytes()[:5000])
    for name in ("folder.mp4", "folder.glb"):
        (tmp_path / name).mkdir()
    before = sorted(os.listdir())
    options = {"--weights": "take.csv", "-o": "out.mp4", "--size": "32", **change}
    avatar = options.pop("avatar", str(glb))
    assert main(["drive", avatar, *(part for pair in options.items() for part in pair)]) == 2
    errors = [line for line in capsys.readouterr().err.splitlines() if line.startswith("toongeo: ")]
    assert len(errors) == 1 and message in errors[0]
    assert sorted(os.listdir()) == before and not os.listdir("folder.mp4")


def test_an_interrupted_video_leaves_the_old_one(tmp_path):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"old")

    def frames():
        yield np.zeros((32, 32, 3), np.uint8)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_video(path, frames(), 32, 30)
    with pytest.raises(ValueError, match=r"frames: expected \(32, 32, 3\) uint8, got \(16, 16, 3\) float64"):
        write_video(path, iter([np.zeros((16, 16, 3))]), 32, 30)
    assert path.read_bytes() == b"old" and os.listdir(tmp_path) == ["a.mp4"]
    with pytest.raises(OSError, match="cannot write"):
        write_video(tmp_path / "none" / "a.mp4", frames(), 32, 30)


def test_an_opencv_without_encoder(tmp_path, monkeypatch):
    monkeypatch.setattr(cv2.VideoWriter, "isOpened", lambda self: False, raising=False)
    monkeypatch.setattr(video, "has_pyav", lambda: False)
    with pytest.raises(OSError, match="OpenCV has no encoder for VP9 and VP8 here"):
        write_video(tmp_path / "a.mp4", iter([]), 32, 30)
    with pytest.raises(ImportError, match=re.escape('sound in a video needs PyAV: pip install "toongeo[video]"')):
        write_video(tmp_path / "a.mp4", iter([]), 32, 30, sound=Sound(tmp_path / "a.wav"))
    monkeypatch.undo()
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("pyav", [False, True])
def test_an_empty_film_is_refused(tmp_path, monkeypatch, pyav):
    if pyav:
        pytest.importorskip("av")
    monkeypatch.setattr(video, "has_pyav", lambda: pyav)
    for name in ("a.mp4", "a.webm"):
        with pytest.raises(OSError, match="0 of 0 frames are in the file"):
            write_video(tmp_path / name, iter([]), 32, 30)
    assert os.listdir(tmp_path) == []


def test_a_take_turns_the_head(glb, avatar, tmp_path, node):
    """To the subject's left, which is the right of the picture; in a file all meshes go with it."""
    angles = np.zeros((4, 3))
    angles[:, 0] = np.linspace(0, 0.6, 4)
    write_live_link(tmp_path / "take.csv", Take(np.arange(4) / 10, np.zeros((4, 54)), angles))
    arguments = ["drive", str(glb), "--weights", str(tmp_path / "take.csv"), "--fps", "10", "--size", "96"]
    assert main([*arguments, "-o", str(tmp_path / "out.mp4")]) == 0
    last = played(tmp_path / "out.mp4")[0][-1].astype(float)
    errors = [np.abs(last - avatar.render(size=96, yaw=yaw)).mean() for yaw in (-34.4, 0, 34.4)]
    assert int(np.argmin(errors)) == 2
    assert main([*arguments, "-o", str(tmp_path / "out.glb")]) == 0
    (verdict,) = node("validate.mjs", tmp_path / "out.glb")
    assert verdict["errors"] == verdict["warnings"] == 0
    scene = glb_scene(read_glb(tmp_path / "out.glb"))
    np.testing.assert_allclose(scene.animation.turns, head_quaternions(angles), atol=1e-6)
    np.testing.assert_allclose(load_avatar(tmp_path / "out.glb").rig.neutral, load_avatar(glb).rig.neutral, atol=1e-9)
    assert main([*arguments, "-o", str(tmp_path / "still.csv")]) == 0
    np.testing.assert_allclose(read_take(tmp_path / "still.csv").head, angles, atol=1e-6)


def test_only_a_stretch_is_played(glb, take, avatar, tmp_path):
    out = tmp_path / "out.webm"
    arguments = [
        "--weights",
        str(take),
        "-o",
        str(out),
        "--size",
        "64",
        "--fps",
        "10",
        "--start",
        "0.2",
        "--end",
        "0.4",
    ]
    assert main(["drive", str(glb), *arguments]) == 0
    frames, _ = played(out)
    assert len(frames) == 3
    for k, frame in enumerate(frames):
        errors = [np.abs(frame - avatar.render({"jawOpen": j / 5}, size=64).astype(float)).mean() for j in range(6)]
        assert int(np.argmin(errors)) == k + 2


@pytest.mark.slow
def test_frames_are_the_same_on_any_number_of_cores(avatar):
    puppet, weights = AvatarPuppet(avatar, 64), np.zeros((6, 54))
    weights[:, EXPRESSIONS.index("jawOpen")] = np.linspace(0, 1, 6)
    draw = _Drawing(puppet, list(weights), None)
    one, several = (list(film_frames(draw, 6, processes=processes)) for processes in (1, 2))
    np.testing.assert_array_equal(one, several)


@pytest.mark.parametrize("where", ["beside", "corner"])
def test_the_actor_is_seen_at_the_same_time(tmp_path, where):
    """Greys of a film of other rate, and of faces, tell when they are."""
    film = tmp_path / "actor.mp4"
    write_video(film, [np.full((48, 96, 3), 10 * k, np.uint8) for k in range(20)], (48, 96), 20)
    faces = [np.full((64, 64, 3), 200, np.uint8) for _ in range(5)]
    shown = list(with_actor(faces, read_video(film), where, fps=10, start=0.3))
    assert shown[0].shape == ((64, 128, 3) if where == "beside" else (64, 64, 3))
    place = (32, 32) if where == "beside" else (57, 53)
    greys = [int(picture[place][0]) for picture in shown]
    np.testing.assert_allclose(greys, [60, 80, 100, 120, 140], atol=4)
    assert all((picture[4, -4] == 200).all() for picture in shown)


@pytest.mark.parametrize("suffix", [".mp4", ".webm"])
def test_sound_is_kept_where_the_film_is(tmp_path, suffix):
    """A tone that begins at 1 s of the sound begins at 0.5 s of a film from 0.5 s; passed through it is the same."""
    av = pytest.importorskip("av")
    samples = np.zeros(2 * 16000)
    samples[16000:] = 8000 * np.sin(2 * np.pi * 440 * np.arange(16000) / 16000)
    with wave.open(str(tmp_path / "tone.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        file.writeframes(samples.astype("<i2").tobytes())
    film, again = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    frames = [np.zeros((32, 32, 3), np.uint8)] * 15
    write_video(film, frames, 32, 10, sound=Sound(tmp_path / "tone.wav", start=0.5))
    write_video(again, frames, 32, 10, sound=Sound(film))
    for path in (film, again):
        with av.open(str(path)) as heard:
            pieces = [piece.to_ndarray()[0] for piece in heard.decode(audio=0)]
        sound = np.concatenate(pieces)
        rate = 48000
        loud = np.flatnonzero(np.abs(sound) > 0.05)
        assert loud[0] / rate == pytest.approx(0.5, abs=0.05)
        assert len(sound) / rate == pytest.approx(1.5, abs=0.06)


def test_view_writes_a_page(glb, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert main(["view", str(glb), "--no-open"]) == 0
    page = capsys.readouterr().out.strip()
    content = Path(page).read_text(encoding="utf-8")
    assert page.startswith(str(tmp_path)) and "<title>face</title>" in content and opened == []
    settings = json.loads(content.split('id="settings">')[1].split("</script>")[0])
    assert settings["live"] is None and settings["presets"]["smile"]["mouthSmileLeft"] > 0.5
    assert main(["view", str(glb)]) == 0
    assert len(opened) == 1 and opened[0].startswith("file://")


def test_what_cannot_be_viewed_or_served(glb, tmp_path, capsys):
    from toongeo.io import Scene, SceneMesh, write_glb

    still = tmp_path / "still.glb"
    write_glb(still, Scene((SceneMesh("still", np.eye(3), np.array([[0, 1, 2]])),)))
    (tmp_path / "cut.glb").write_bytes(glb.read_bytes()[:-9])
    for command in ("view", "serve"):
        for name, message in (
            ("none.glb", "none.glb"),
            ("cut.glb", "cut.glb is damaged or none"),
            ("still.glb", "expected an avatar, got a GLB without named morph targets"),
        ):
            assert main([command, str(tmp_path / name), "--no-open"]) == 2
            assert message in capsys.readouterr().err


@pytest.fixture(scope="module")
def actor(performance, tmp_path_factory):
    """The film as a file."""
    path = tmp_path_factory.mktemp("actor") / "actor.mp4"
    write_video(path, performance.frames, 240, performance.fps)
    return path


@pytest.mark.slow
def test_a_film_drives(glb, actor, performance, tmp_path, capsys):
    """Weights that are read off a film of another size and rate, and played again."""
    table = tmp_path / "take.csv"
    assert main(["drive", str(glb), "--video", str(actor), "-o", str(table), "--fps", "10"]) == 0
    take = read_take(table)
    np.testing.assert_allclose(take.times, np.arange(24) / 10, atol=1e-4)
    seen, acted = ~performance.hidden, performance.weights.any(axis=0)
    truth = performance.weights[seen][:, acted]
    assert rms(take.weights[seen, :46][:, acted] - truth) < 0.75 * rms(truth)
    smile = EXPRESSIONS.index("mouthSmileLeft")
    assert np.corrcoef(take.weights[seen, smile], performance.weights[seen, smile])[0, 1] > 0.9
    assert main(["drive", str(glb), "--weights", str(table), "-o", str(tmp_path / "take.glb")]) == 0
    assert capsys.readouterr().out.count("wrote ") == 2


def test_films_that_cannot_drive(glb, actor, tmp_path, capsys):
    from toongeo.app.read_take import TakeSource

    wall, one, text = tmp_path / "wall.mp4", tmp_path / "one.mp4", tmp_path / "text.mp4"
    write_video(wall, [np.full((64, 64, 3), 90, np.uint8)] * 2, 64, 10)
    write_video(one, [np.full((64, 64, 3), 90, np.uint8)], 64, 10)
    text.write_text("no film")
    (tmp_path / "empty.mp4").touch()
    for path, message in (
        (wall, "wall.mp4: frames: no face was found in any of 2 frames"),
        (one, "one.mp4: expected a video of several frames, got a single one"),
        (text, "text.mp4: expected a video, got a file that OpenCV cannot open"),
        (tmp_path / "empty.mp4", "empty.mp4: expected a video, got an empty file"),
        (tmp_path / "none.mp4", "none.mp4"),
    ):
        assert main(["drive", str(glb), "--video", str(path), "-o", str(tmp_path / "out.csv")]) == 2
        assert message in capsys.readouterr().err
    assert main(["drive", str(glb), "--video", str(actor), "-o", str(actor)]) == 2
    assert "but" in capsys.readouterr().err and not (tmp_path / "out.csv").exists()
    for files in ({}, {"weights": actor, "video": actor}):
        with pytest.raises(ValueError, match="weights, landmarks, video: expected one of the three"):
            TakeSource(**files)
