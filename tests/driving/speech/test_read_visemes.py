"""Timings of visemes as lip-sync programs write them."""

import json

import numpy as np
import pytest

from toongeo.driving import VisemeTrack, read_visemes
from toongeo.driving.speech.viseme_table import AZURE, RHUBARB, VISEMES
from toongeo.model.expression_schemes import SCHEMES

CUES = [(0.0, 0.1, "X"), (0.1, 0.25, "D"), (0.25, 0.4, "A"), (0.4, 0.9, "F")]
NAMES = ("sil", "aa", "PP", "ou")
EVENTS = [(0.0, 0), (0.1, 2), (0.25, 21), (0.4, 7)]
STARTS, ENDS = [0.0, 0.1, 0.25, 0.4], [0.1, 0.25, 0.4, 0.9]


def ticks(seconds):
    return round(seconds * 1e7)


FILES = {
    "rhubarb.json": json.dumps(
        {"metadata": {"duration": 0.9}, "mouthCues": [{"start": a, "end": b, "value": v} for a, b, v in CUES]}
    ),
    "rhubarb.tsv": "".join(f"{a:.2f}\t{v}\n" for a, _, v in CUES),
    "head.json": json.dumps(
        {
            "words": ["boo"],
            "wtimes": [0],
            "wdurations": [900],
            "visemes": ["sil", "aa", "viseme_PP", "U"],
            "vtimes": [0, 100, 250, 400],
            "vdurations": [100, 150, 150, 500],
        }
    ),
    "azure.json": json.dumps([{"audioOffset": ticks(a), "visemeId": v} for a, v in EVENTS]),
    "azure_python.json": json.dumps({"events": [{"audio_offset": ticks(a), "viseme_id": v} for a, v in EVENTS]}),
    "azure_csharp.json": "\ufeff" + json.dumps([{"AudioOffset": ticks(a), "VisemeId": str(v)} for a, v in EVENTS]),
}
OPEN_ENDED = [name for name in FILES if name.startswith("azure") or name.endswith("tsv")]


@pytest.mark.parametrize("name", FILES)
def test_every_format_tells_the_same(tmp_path, name):
    (tmp_path / name).write_text(FILES[name], encoding="utf-8")
    track = read_visemes(tmp_path / name)
    assert track.names == NAMES
    np.testing.assert_allclose(track.starts, STARTS, atol=1e-9)
    ends = [*ENDS[:-1], 0.5] if name in OPEN_ENDED else ENDS  # of the last one only the beginning is told
    np.testing.assert_allclose(track.ends, ends, atol=1e-9)
    assert track.seconds == pytest.approx(ends[-1])


def test_tables_know_all_names():
    assert tuple(VISEMES) == tuple(SCHEMES["oculus"])
    assert sorted(RHUBARB) == list("ABCDEFGHX") and sorted(AZURE) == list(range(22))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "expected visemes, got none"),
        ("0.0\tX\n0.1\tQ\n", "line 2: expected a time and a letter of XAG"),
        ("zero\tX\n", "line 1: expected a number, got 'zero'"),
        ("0.2\tX\n0.1\tA\n", "starts, ends: expected seconds >= 0 that do not go back"),
        ("-1\tX\n", "starts, ends: expected seconds >= 0"),
        ("nan\tX\n", "starts, ends: expected finite seconds"),
        ("1e9\tX\n", "ends: expected seconds of some hours at most"),
        ("{", "expected JSON, got a file that is none"),
        ('{"a": 1, "b": 2}', "expected mouthCues"),
        ('{"words": ["a"], "wtimes": [0]}', "expected visemes and vtimes, got words alone"),
        ('{"mouthCues": [{"start": 0, "end": 1, "value": "Z"}]}', r"mouthCues\[0\]: expected start, end and a value"),
        ('{"mouthCues": [{"start": null, "end": 1, "value": "A"}]}', r"mouthCues\[0\]: expected a number, got None"),
        ('{"visemes": ["aa"], "vtimes": [0, 1]}', "visemes, vtimes, vdurations: expected lists of one length"),
        ('{"visemes": ["xx"], "vtimes": [0]}', r"visemes\[0\]: expected visemes sil PP"),
        ('[{"audioOffset": 0, "visemeId": 22}]', "event 0: expected audioOffset and a visemeId of 0 to 21"),
        ("[3]", "event 0: expected a number, got None"),
    ],
)
def test_other_files_are_refused(tmp_path, text, message):
    (tmp_path / "a.txt").write_text(text)
    with pytest.raises(ValueError, match=f"a.txt: {message}"):
        read_visemes(tmp_path / "a.txt")


def test_a_track_must_be_one():
    with pytest.raises(ValueError, match="names: expected visemes sil PP .* got 'X'"):
        VisemeTrack(("X",), np.zeros(1), np.ones(1))
    with pytest.raises(ValueError, match="starts, ends: expected a time for each of one viseme or more"):
        VisemeTrack((), np.zeros(0), np.zeros(0))
    assert not VisemeTrack(("aa",), np.zeros(1), np.ones(1)).starts.flags.writeable
