"""Counts, p-values and complaints."""

import json

import numpy as np
import pytest

from toongeo.app.bench.score_answers import Preference, preferences_text, score_answers

HEAD = "picture,question,answer"


@pytest.fixture
def key(tmp_path):
    """Ten pairs; ours is A in the even ones."""
    pairs = {
        f"pair-{k:02d}": {
            "picture": f"{k}.png",
            "A": ("ours", "baseline")[k % 2],
            "B": ("baseline", "ours")[k % 2],
        }
        for k in range(10)
    }
    path = tmp_path / ".key.json"
    path.write_text(json.dumps({"baseline": "coarse", "seed": 0, "pairs": pairs}))
    return path


def filled(tmp_path, lines):
    path = tmp_path / "answers.csv"
    path.write_text("\n".join([HEAD, *lines]))
    return path


def ours(k):
    return "AB"[k % 2]


def test_round_trip_through_the_key(tmp_path, key, rng):
    chosen = rng.random((10, 3)) < 0.6
    questions = ("aesthetics", "accuracy", "similarity")
    lines = [
        f"pair-{k:02d},{question},{ours(k) if chosen[k, q] else ours(k + 1)}"
        for k in range(10)
        for q, question in enumerate(questions)
    ]
    found = score_answers(filled(tmp_path, lines), key)
    assert [p.question for p in found] == list(questions)
    np.testing.assert_array_equal([[p.first, p.second] for p in found], np.c_[chosen.sum(0), 10 - chosen.sum(0)])


def test_p_values_are_exact(tmp_path, key):
    lines = [f"pair-{k:02d},accuracy,{ours(k)}" for k in range(10)]
    lines += [f"pair-{k:02d},similarity,A" for k in range(10)]
    lines += [f"pair-{k:02d},aesthetics,{ours(k + (k == 3))}" for k in range(10)]
    aesthetics, accuracy, similarity = score_answers(filled(tmp_path, lines), key)
    assert accuracy.p_value == pytest.approx(2 / 2**10)
    assert similarity.p_value == 1.0  # A in all of them is no preference
    assert aesthetics.p_value == pytest.approx(2 * (1 + 10) / 2**10)


def test_empty_answers_spaces_letters_and_several_forms(tmp_path, key):
    lines = ["pair-00,Accuracy, a ", "pair-01,accuracy,", "", HEAD, "pair-00,accuracy,A", "pair-00,accuracy,b"]
    found = score_answers(filled(tmp_path, lines), key)
    assert found[1] == Preference("accuracy", 2, 1, 1.0) and found[0] == Preference("aesthetics", 0, 0, 1.0)
    text = preferences_text(found)
    assert "66.7 %" in text and len(text.splitlines()) == 5


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("pair-77,accuracy,A", "answers: expected picture one of pair-00, .*, got 'pair-77' in line 2"),
        ("pair-00,beauty,A", "answers: expected question one of aesthetics, accuracy, similarity, got 'beauty'"),
        ("pair-00,accuracy,C", "answers: expected answer one of A, B, got 'C' in line 2"),
        ("pair-00,accuracy", "answers: expected 3 cells, got 2 in line 2"),
        ("pair-00,accuracy,", "answers: expected at least one answer A or B, got none"),
    ],
)
def test_bad_lines_are_named(tmp_path, key, line, message):
    with pytest.raises(ValueError, match=message):
        score_answers(filled(tmp_path, [line]), key)


def test_other_sides_have_their_names(tmp_path, key):
    pairs = {
        "pair-01": {"picture": "a.png", "A": "old", "B": "new"},
        "pair-02": {"picture": "b.png", "A": "new", "B": "old"},
    }
    key.write_text(json.dumps({"sides": ["new", "old"], "seed": 3, "pairs": pairs}))
    found = score_answers(filled(tmp_path, ["pair-01,accuracy,B", "pair-02,accuracy,A", "pair-02,similarity,B"]), key)
    assert found[1:] == [
        Preference("accuracy", 2, 0, 0.5, ("new", "old")),
        Preference("similarity", 0, 1, 1.0, ("new", "old")),
    ]
    lines = preferences_text(found).splitlines()
    assert lines[0].split() == ["question", "new", "old", "share", "p"] and lines[-1].startswith(
        "share: preferred new;"
    )


def test_bad_files_are_named(tmp_path, key):
    path = tmp_path / "answers.csv"
    for content, message in (
        (b"", "answers: expected the heading picture,question,answer, got 'nothing'"),
        (b"a,b\n", "answers: expected the heading picture,question,answer, got 'a,b'"),
        (b"\xff\xfe\x00", "answers: expected a CSV file"),
    ):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=message):
            score_answers(path, key)
    good = filled(tmp_path, ["pair-00,accuracy,A"])
    for content in ("no json", "[]", "{}", '{"pairs": {"pair-00": {"A": "ours"}}}', '{"pairs": 3}'):
        key.write_text(content)
        with pytest.raises(ValueError, match="key: expected the key that `toongeo bench pairs` wrote"):
            score_answers(good, key)
    for content in ('{"pairs": {}}', '{"pairs": {"pair-00": {"A": "ours", "B": "ours"}}}'):
        key.write_text(content)
        with pytest.raises(ValueError, match="key: expected ours and baseline for the letters of each pair"):
            score_answers(good, key)
