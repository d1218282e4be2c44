"""Tables of weights as apps and converters write them."""

import csv

import numpy as np
import pytest

from toongeo.driving import read_live_link
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

LIVE_LINK = tuple(SCHEMES["live_link"])
JAW = EXPRESSIONS.index("jawOpen")


def write_take(path, values, names=LIVE_LINK, codes=None, count=61, delimiter=",", time="Timecode"):
    """A file as the app writes it; ``values`` is (f, names), or rows of cells."""
    codes = codes or [f"10:59:{59 + i // 30:02d}:{i % 30:02d}.000" for i in range(len(values))]
    rows = [[code, count, *map(str, row)] for code, row in zip(codes, values, strict=True)]
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, delimiter=delimiter).writerows([[time, "BlendShapeCount", *names], *rows])
    return path


def edited(path, change):
    path.write_text(change(path.read_text()))
    return path


@pytest.fixture
def values(rng):
    return rng.random((40, 61)).round(3)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "take.csv"


@pytest.fixture
def plain(tmp_path, values):
    return read_live_link(write_take(tmp_path / "plain.csv", values))


def test_a_plain_take_has_nothing_to_note(plain, values):
    np.testing.assert_array_equal(plain.weights[:, JAW], values[:, LIVE_LINK.index("JawOpen")])
    assert plain.notes == ()


@pytest.mark.parametrize("count", [0.5, 17, 51, 52, 61, ""])
def test_the_count_of_expressions_tells_nothing(path, values, plain, count):
    np.testing.assert_array_equal(read_live_link(write_take(path, values, count=count)).weights, plain.weights)


@pytest.mark.parametrize(("delimiter", "comma"), [(";", False), (";", True), ("\t", False), ("\t", True)])
@pytest.mark.parametrize("tail", [False, True])
def test_delimiters_and_decimal_commas(path, values, plain, delimiter, comma, tail):
    write_take(path, values, delimiter=delimiter)
    if comma:
        edited(path, lambda text: text.replace(".", ","))
    if tail:
        edited(path, lambda text: text.replace("\n", f"{delimiter}\n"))
    take = read_live_link(edited(path, lambda text: "\ufeff" + text))
    np.testing.assert_array_equal(take.weights, plain.weights)
    np.testing.assert_array_equal(take.times, plain.times)
    assert take.notes == ()


def test_columns_that_are_no_expression_are_left_out(path, values, plain):
    write_take(path, np.c_[values, np.arange(40)], [*LIVE_LINK, "SubjectNaem"])
    take = read_live_link(path)
    np.testing.assert_array_equal(take.weights, plain.weights)
    assert take.notes == ("columns that are no expression were left out: 'SubjectNaem'",)


def test_a_misspelt_column_is_told(path, values):
    take = read_live_link(edited(write_take(path, values), lambda text: text.replace("JawOpen", "JawOpem")))
    assert "'JawOpem' (did you mean JawOpen?)" in take.notes[0]
    assert take.notes[1] == "1 of 52 expressions have no column and stay 0: JawOpen"
    assert not take.weights[:, JAW].any()


def test_any_columns_do(path):
    path.write_text("time,jawOpen,browInnerUpLeft\n1.5,0.25,0.5\n2.0,0.75,0\n")
    take = read_live_link(path)
    np.testing.assert_array_equal(take.times, [0, 0.5])
    expected = np.zeros((2, 54))
    expected[:, JAW], expected[0, EXPRESSIONS.index("browInnerUpLeft")] = (0.25, 0.75), 0.5
    np.testing.assert_array_equal(take.weights, expected)
    assert take.notes[0].startswith("50 of 52 expressions have no column")


def test_frames_without_a_face_are_filled(path, values, plain):
    write_take(path, values)
    lines = path.read_text().splitlines()
    lines[11] = ",".join([lines[11].split(",")[0], "0"])  # as the app does
    lines[12] = ",".join([*lines[12].split(",")[:2], *["nan"] * 61])
    lines[40] = ",".join([*lines[40].split(",")[:2], *[""] * 61])
    path.write_text("\n".join(lines))
    take = read_live_link(path)
    before, after = plain.weights[9], plain.weights[12]
    np.testing.assert_allclose(take.weights[[10, 11]], [before + (after - before) / 3, before + (after - before) / 1.5])
    np.testing.assert_array_equal(take.weights[39], plain.weights[38])
    assert take.notes == ("3 of 40 frames have gaps, which were filled from the frames around",)


def test_a_frame_that_comes_twice_counts_once(path, values, plain):
    codes = [f"10:59:{59 + i // 30:02d}:{i % 30:02d}.000" for i in [*range(20), 19, *range(20, 40)]]
    take = read_live_link(write_take(path, np.insert(values, 20, 9, axis=0), codes=codes))
    np.testing.assert_array_equal(take.weights, plain.weights)
    np.testing.assert_array_equal(take.times, plain.times)
    assert take.notes == ("1 frames with the time of the one before were left out",)


def test_a_line_that_is_cut_off_is_left_out(path, values, plain):
    take = read_live_link(edited(write_take(path, values), lambda text: text[:-100]))
    np.testing.assert_array_equal(take.weights, plain.weights[:-1])
    assert take.notes == ("line 41, the last, is cut off and was left out",)


def test_percent(path, values, plain):
    take = read_live_link(write_take(path, 100 * values))
    np.testing.assert_allclose(take.weights, plain.weights)
    assert take.notes[0].startswith("weights of up to") and "were taken for percent" in take.notes[0]
    with pytest.raises(ValueError, match="expected weights of 0 to 1, or percent, got up to 1e\\+09"):
        read_live_link(write_take(path, np.full((2, 61), 1e9)))


def test_order_case_and_rotations_of_a_file_do_not_matter(tmp_path, rng):
    names = [name.swapcase() for name in LIVE_LINK if SCHEMES["live_link"][name]]
    values = rng.random((2, 52))
    order = rng.permutation(52)
    first = read_live_link(write_take(tmp_path / "a.csv", values, names, count=52))
    path = write_take(tmp_path / "b.csv", values[:, order], [names[k] for k in order], count=52)
    path.write_text(path.read_text() + "\n,\n\n", encoding="utf-8")  # lines without a cell
    np.testing.assert_array_equal(read_live_link(path).weights, first.weights)
    assert first.head is None


@pytest.mark.parametrize("rate", [24, 25, 30, 60, 100, 120, 240, 1000])
def test_times_by_time_code(path, rate):
    first = rate - 2
    codes = [f"23:59:{59 + (i + first) // rate:02d}:{(i + first) % rate:02d}.500" for i in range(4)]
    codes = [code.replace("23:59:60", "00:00:00") for code in codes]  # midnight
    take = read_live_link(write_take(path, np.zeros((4, 61)), codes=codes))
    np.testing.assert_allclose(take.times, np.arange(4) / rate, atol=1e-9)


@pytest.mark.parametrize(
    ("heading", "cells"),
    [
        ("Timecode", ["00:00:59.500", "00:01:00.000", "00:01:01.250"]),
        ("Timecode", ["00:00:59", "00:01:00", "00:01:01"]),
        ("Seconds", ["7", "7.5", "8.75"]),
        ("time_ms", ["100", "600", "1850"]),
        ("frame", ["30", "60", "135"]),
    ],
)
def test_times_of_other_columns(path, heading, cells):
    times = read_live_link(write_take(path, np.zeros((3, 61)), codes=cells, time=heading)).times
    np.testing.assert_allclose(times, [0, 1, 2] if cells[0] == "00:00:59" else [0, 0.5, 1.75])


def test_times_without_a_column_or_by_rate(path):
    path.write_text("jawOpen\n0\n0\n0\n")
    np.testing.assert_allclose(read_live_link(path).times, [0, 1 / 60, 2 / 60])
    np.testing.assert_allclose(read_live_link(path, fps=10).times, [0, 0.1, 0.2])
    with pytest.raises(ValueError, match="fps: expected a rate > 0, got -1"):
        read_live_link(path, fps=-1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("JawOpen", "JawLeft"), "column 'JawLeft' is there twice"),
        (lambda text: text.replace(",61,", ",61,x", 1), "line 2: expected a number in column EyeBlinkLeft, got 'x"),
        (lambda text: text.replace(",61,", ",61,inf", 1), "line 2: expected a number in column EyeBlinkLeft, got 'inf"),
        (lambda text: text.replace(",61,", ",61,nan,", 1), "line 2: expected 63 cells as in the heading, got 64"),
        (lambda text: text.replace(",61,", ",", 1), "line 2: expected 63 cells as in the heading, got 62"),
        (lambda text: text.replace("10:59:59:01", "yesterday"), "line 3: expected HH:MM:SS:FF.f in column Timecode"),
        (lambda text: text.replace("10:59:59:01", "1" * 400 + ":59:59:01"), "line 3: expected HH:MM:SS:FF.f"),
        (lambda text: text.replace("10:59:59:02", "10:59:59:00"), "line 4: expected a Timecode after the one before"),
        (lambda text: text.splitlines()[0], "expected a heading and at least one frame, got 1 lines"),
        (lambda text: "", "expected a heading and at least one frame, got 0 lines"),
        (lambda text: "a,b\n1,2\n", "expected columns named like ARKit's expressions, got a, b"),
        (lambda text: "time,jawOpen\n1,2\n,3\n", "line 3: expected a number in column time, got none"),
        (lambda text: "jawOpen,jawLeft\n1,nan\n1,\n", "column JawLeft: expected a number in at least one frame"),
        (lambda text: "time,jawOpen\n1,2\n1,2\n1,2\n", "line 3: expected a time after the one before, got '1'"),
    ],
)
def test_a_bad_file_is_told_where(path, values, change, message):
    edited(write_take(path, values), change)
    with pytest.raises(ValueError, match=message) as error:
        read_live_link(path)
    assert "take.csv" in str(error.value)


def test_what_is_no_text_or_no_file(tmp_path):
    (tmp_path / "take.csv").write_bytes(bytes(range(256)) * 8)
    with pytest.raises(ValueError, match="expected a CSV file in UTF-8"):
        read_live_link(tmp_path / "take.csv")
    with pytest.raises(FileNotFoundError, match=r"none\.csv"):
        read_live_link(tmp_path / "none.csv")


def test_gaps_may_be_held(path):
    """Of a table whose numbers begin late and pause: the last number, or the first that there is."""
    path.write_text("time,jawOpen\n0,\n1,0.5\n2,\n3,\n4,1\n", encoding="utf-8")
    held, drawn = read_live_link(path, gaps="hold"), read_live_link(path)
    assert held.weights[:, JAW].tolist() == [0.5, 0.5, 0.5, 0.5, 1]
    np.testing.assert_allclose(drawn.weights[:, JAW], [0.5, 0.5, 2 / 3, 5 / 6, 1])
    assert held.notes[-1].endswith("which were filled from the frames before")
    with pytest.raises(ValueError, match="gaps: expected 'interpolate' or 'hold', got 'zero'"):
        read_live_link(path, gaps="zero")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
@pytest.mark.parametrize("before", ["", "sep=|\n", "# recorded on Monday, 10:59\n"])
def test_what_spreadsheets_put_before_the_heading(path, values, plain, encoding, before):
    write_take(path, values, delimiter="|")
    path.write_bytes((before + path.read_text()).encode(encoding))
    take = read_live_link(path)
    np.testing.assert_array_equal(take.weights, plain.weights)
    np.testing.assert_array_equal(take.times, plain.times)


@pytest.mark.parametrize(
    "row", [["0"] + ["0"] * 61, ["0"] + ["0.000"] * 61, ["61"] + ["#N/A"] * 61, ["61"] + ["n/a"] * 61, []]
)
def test_a_frame_without_a_face_however_it_is_written(path, values, plain, row):
    lines = write_take(path, values).read_text().splitlines()
    lines[7] = ",".join([lines[7].split(",")[0], *row])
    path.write_text("\n".join(lines))
    take = read_live_link(path)
    np.testing.assert_allclose(take.weights[6], (plain.weights[5] + plain.weights[7]) / 2)
    assert take.notes[0].startswith("1 of 40 frames have gaps")


@pytest.mark.parametrize("names", [("jaw_open", "eyeBlink_L"), ("blendShape1.jawOpen", "A14_Eye_Blink_Left")])
def test_names_as_other_programs_write_them(path, names):
    path.write_text(f"time,{names[0]},{names[1]}\n0,0.5,1\n1,0,0\n")
    weights = read_live_link(path).weights[0]
    assert {EXPRESSIONS[k]: weights[k] for k in np.flatnonzero(weights)} == {"jawOpen": 0.5, "eyeBlinkLeft": 1}


def test_drop_frame_codes_keep_with_the_clock(path):
    def label(frame):  # SMPTE 12M: 2 of 1800 labels are left out each minute, but not each tenth
        tens, rest = divmod(frame, 17982)
        frame += 18 * tens + (2 * ((rest - 2) // 1798) if rest > 2 else 0)
        return f"{frame // 108000:02}:{frame // 1800 % 60:02}:{frame // 30 % 60:02};{frame % 30:02}"

    frames = np.arange(0, 20000, 7)
    write_take(path, np.zeros((len(frames), 1)), ["JawOpen"], codes=list(map(label, frames)))
    np.testing.assert_allclose(read_live_link(path).times, frames * 1001 / 30000, atol=1e-9)


def test_codes_of_film_on_american_television(path):
    codes = [f"00:{k // 1440:02}:{k // 24 % 60:02}:{k % 24:02}" for k in range(3000)]
    write_take(path, np.zeros((3000, 1)), ["JawOpen"], codes=codes)
    np.testing.assert_allclose(read_live_link(path, fps=23.976).times, np.arange(3000) / 23.976, atol=1e-9)
    np.testing.assert_allclose(read_live_link(path).times, np.arange(3000) / 24, atol=1e-9)


def test_midnight_of_drop_frame_codes(path):
    codes = ["23:59:59;28", "23:59:59;29", "00:00:00;00", "00:00:00;01"]
    write_take(path, np.zeros((4, 1)), ["JawOpen"], codes=codes)
    np.testing.assert_allclose(np.diff(read_live_link(path).times), 1001 / 30000, atol=1e-6)


@pytest.mark.parametrize(("unit", "start"), [(1e3, 0), (1e3, 1.7e12), (1e6, 1.7e15), (1e9, 1.7e18)])
def test_a_clock_that_counts_parts_of_seconds(path, unit, start):
    times = [str(int(start) + round(k * unit / 50)) for k in range(9)]
    path.write_text("timestamp,jawOpen\n" + "".join(f"{time},0\n" for time in times))
    take = read_live_link(path)
    np.testing.assert_allclose(take.times, np.arange(9) / 50, atol=1e-6)
    assert "taken for 1/1000" in take.notes[0]


def test_turns_of_the_head_in_degrees(path, values, plain):
    turned = values.copy()
    turned[:, [name.startswith("Head") for name in LIVE_LINK]] *= 90
    take = read_live_link(write_take(path, turned))
    np.testing.assert_allclose(take.head, np.radians(plain.head * 90))
    assert "taken for degrees" in take.notes[0]
