"""What a phone recorded, column by column."""

import csv

import numpy as np
import pytest

from toongeo.driving import ArkitDriver, Take, read_live_link
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

LIVE_LINK, ARKIT = tuple(SCHEMES["live_link"]), tuple(SCHEMES["arkit"])


def write_take(path, values, names=LIVE_LINK, timecodes=None, count=61):
    """A file as the app writes it; ``values`` is (f, names)."""
    codes = timecodes or [f"10:59:{59 + i // 30:02d}:{i % 30:02d}.000" for i in range(len(values))]
    rows = [[code, count, *(repr(float(x)) for x in row)] for code, row in zip(codes, values, strict=True)]
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["Timecode", "BlendshapeCount", *names], *rows])
    return path


@pytest.fixture
def take(tmp_path, rng):
    values = rng.random((3, 61))
    return values, write_take(tmp_path / "take.csv", values)


def test_each_column_goes_to_its_expression(take):
    values, path = take
    found = ArkitDriver().frames(path)
    assert found.shape == (3, 54)
    for name in EXPRESSIONS:
        twin = {"browInnerUpLeft": "browInnerUp", "browInnerUpRight": "browInnerUp"}.get(name, name)
        twin = "cheekPuff" if twin.startswith("cheekPuff") else twin
        column = LIVE_LINK.index(twin[0].upper() + twin[1:])
        np.testing.assert_array_equal(found[:, EXPRESSIONS.index(name)], values[:, column], err_msg=name)
    head = [LIVE_LINK.index(name) for name in ("HeadYaw", "HeadPitch", "HeadRoll")]
    np.testing.assert_array_equal(read_live_link(path).head, values[:, head])


def test_file_and_array_agree(take):
    values, path = take
    by_name = {name.lower(): values[:, i] for i, name in enumerate(LIVE_LINK)}
    array = np.column_stack([by_name[name.lower()] for name in ARKIT])
    np.testing.assert_array_equal(ArkitDriver().frames(array), ArkitDriver().frames(path))
    shuffled = list(reversed(ARKIT))
    np.testing.assert_array_equal(ArkitDriver(shuffled).frames(array[:, ::-1]), ArkitDriver().frames(array))
    np.testing.assert_array_equal(ArkitDriver().frames(array[0]), ArkitDriver().frames(array[:1]))


def test_order_case_and_rotations_of_a_file_do_not_matter(tmp_path, rng):
    names = [name.swapcase() for name in LIVE_LINK if SCHEMES["live_link"][name]]
    values = rng.random((2, 52))
    order = rng.permutation(52)
    first = read_live_link(write_take(tmp_path / "a.csv", values, names, count=52))
    path = write_take(tmp_path / "b.csv", values[:, order], [names[k] for k in order], count=52)
    path.write_text("\ufeff" + path.read_text() + "\n,\n", encoding="utf-8")  # a byte order mark and empty lines
    path.write_text(path.read_text().replace("\n,\n", "\n\n"))
    np.testing.assert_array_equal(read_live_link(path).weights, first.weights)
    assert first.head is None


@pytest.mark.parametrize(
    ("recording", "message"),
    [
        (np.zeros((3, 51)), r"recording: expected \(f, 52\) weights, got \(3, 51\)"),
        (np.full((2, 52), np.nan), "recording: expected finite weights, got nan for eyeBlinkLeft in frame 0"),
        ([["a"] * 52], r"recording: expected numbers \(f, 52\)"),
        (np.full((1, 52), 80.0), "recording: expected weights of 0 to 1, got up to 80; divide percent by 100"),
    ],
)
def test_arrays_that_are_none(recording, message):
    with pytest.raises(ValueError, match=message):
        ArkitDriver().frames(recording)


def test_columns_must_be_names_of_arkit():
    with pytest.raises(ValueError, match="columns: expected names of ARKit, each once, got unknown: jawOpem"):
        ArkitDriver(["jawOpem"])
    with pytest.raises(ValueError, match="got a name twice"):
        ArkitDriver(["jawOpen", "jawOpen"])


def test_a_take_between_its_frames():
    weights = np.zeros((3, 54))
    weights[:, 0] = 0.0, 1.0, 0.0
    take = Take(np.array([0.0, 0.5, 1.0]), weights, np.ones((3, 3)))
    finer = take.resampled(4)
    np.testing.assert_allclose(finer.times, [0, 0.25, 0.5, 0.75, 1])
    np.testing.assert_allclose(finer.weights[:, 0], [0, 0.5, 1, 0.5, 0])
    np.testing.assert_array_equal(finer.head, np.ones((5, 3)))
    assert take.seconds == 1.0 and len(Take.of_frames(weights, 30).resampled(30).times) == 3


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Take(np.zeros(1), np.zeros((1, 46))), r"weights: expected \(1, 54\), got \(1, 46\)"),
        (lambda: Take(np.zeros(2), np.zeros((2, 54))), "times: expected at least one frame, at increasing seconds"),
        (lambda: Take(np.zeros(0), np.zeros((0, 54))), "times: expected at least one frame"),
        (lambda: Take(np.zeros(1), np.full((1, 54), np.nan)), "weights: expected finite numbers"),
        (lambda: Take.of_frames(np.zeros((1, 54)), 0), "fps: expected a rate > 0, got 0"),
        (lambda: Take.of_frames(np.zeros((1, 54)), 30).resampled(np.inf), "fps: expected a rate > 0, got inf"),
        (
            lambda: Take(np.array([0.0, 8e4]), np.zeros((2, 54))).resampled(60),
            "fps: expected at most 1000000 frames, got 80000 s at 60 frames a second",
        ),
    ],
)
def test_takes_that_are_none(make, message):
    with pytest.raises(ValueError, match=message):
        make()
