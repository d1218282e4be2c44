"""Names of expressions in several systems: complete, consistent, and turned into our own."""

import csv

import numpy as np
import pytest

from toongeo.model import data_path, expression_weights, preset
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.expression_schemes import EXPRESSIONS, GAZE, PRESETS, SCHEMES


def rows(table):
    with open(data_path(f"data_templates/{table}"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_our_own_names_are_those_of_the_rig(model):
    assert (*model.expression_names[: model.n_named], *GAZE_NAMES) == EXPRESSIONS
    assert GAZE == GAZE_NAMES
    assert all(expression_weights({name: 0.3}) == {name: 0.3} for name in EXPRESSIONS)


def test_arkit_names_reach_each_of_ours_once():
    """Together the 52 move every one of our 54 names at weight 1: ARKit's face is ours, cut differently."""
    assert len(SCHEMES["arkit"]) == 52
    total = np.sum([[names.get(own, 0.0) for own in EXPRESSIONS] for names in SCHEMES["arkit"].values()], axis=0)
    np.testing.assert_array_equal(total, np.ones(54))
    assert {row["arkit"] for row in rows("expressions.csv")} | set(GAZE) == set(SCHEMES["arkit"])


def test_expressions_csv_and_the_scheme_agree_on_arkit():
    for row in rows("expressions.csv"):
        assert SCHEMES["arkit"][row["arkit"]][row["name"]] == 1


def test_mediapipe_is_arkit_without_the_tongue_and_with_its_neutral_score():
    assert set(SCHEMES["mediapipe"]) == {*SCHEMES["arkit"], "_neutral"} - {"tongueOut"}
    assert next(iter(SCHEMES["mediapipe"])) == "_neutral" and not SCHEMES["mediapipe"]["_neutral"]


def test_live_link_columns_are_arkit_in_capitals_and_nine_rotations():
    names = list(SCHEMES["live_link"])
    assert len(names) == 61
    assert {name[0].lower() + name[1:] for name in names[:52]} == set(SCHEMES["arkit"])
    assert names[52:] == [
        f"{what}{axis}" for what in ("Head", "LeftEye", "RightEye") for axis in ("Yaw", "Pitch", "Roll")
    ]
    for name in names[:52]:
        assert SCHEMES["live_link"][name] == SCHEMES["arkit"][name[0].lower() + name[1:]]
    assert not any(SCHEMES["live_link"][name] for name in names[52:])


def test_a_name_means_the_same_wherever_it_occurs():
    """So that it may be looked up without its scheme: the weights a row has are those of the name."""
    for row in rows("expression_schemes.csv"):
        literal = [part.partition(":") for part in row["weights"].split()]
        expected = expression_weights({name: float(weight or 1) for name, _, weight in literal})
        assert dict(SCHEMES[row["scheme"]][row["name"]]) == pytest.approx(expected), row
        assert expression_weights({row["name"]: 1.0}) == pytest.approx(expected), row


def test_every_action_unit_of_our_expressions_moves_them():
    for row in rows("expressions.csv"):
        for unit in row["action_units"].split("+"):
            if unit and unit not in ("AU30", "AD30"):
                moved = SCHEMES["facs"][unit]
                assert row["name"] in moved or unit == "AU25", (unit, row["name"])


def test_both_sides_of_a_unit_make_the_whole():
    for name, whole in SCHEMES["facs"].items():
        if f"{name}L" in SCHEMES["facs"]:
            assert expression_weights({f"{name}L": 1, f"{name}R": 1}) == pytest.approx(dict(whole))


def mirrored(weights):
    swap = {"Left": "Right", "Right": "Left"}
    return {next((n[: -len(s)] + swap[s] for s in swap if n.endswith(s)), n): w for n, w in weights.items()}


@pytest.mark.parametrize(
    "name", [name for name in PRESETS if not name.startswith("wink")] + [n for n in SCHEMES["vrm"] if "Left" not in n]
)
def test_presets_are_symmetric_but_the_winks(name):
    if name in ("blinkRight", "lookRight", "lookLeft"):
        pytest.skip("one side by definition")
    weights = expression_weights({name: 1})
    assert mirrored(weights) == weights


def test_the_sides_mirror_each_other():
    assert mirrored(preset("wink_left")) == preset("wink_right") and preset("wink") == preset("wink_left")
    vrm = SCHEMES["vrm"]
    assert mirrored(vrm["lookLeft"]) == dict(vrm["lookRight"]) and mirrored(vrm["blinkLeft"]) == dict(vrm["blinkRight"])
    for name, weights in SCHEMES["facs"].items():
        if name.endswith("L"):
            assert mirrored(weights) == dict(SCHEMES["facs"][f"{name[:-1]}R"])


def test_all_weights_are_in_range():
    for names in (*SCHEMES.values(), PRESETS):
        for name, weights in names.items():
            assert all(0 < weight <= 1 for weight in weights.values()), name
            assert set(weights) <= set(EXPRESSIONS)


def test_oculus_and_vrm_are_complete():
    visemes = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou"]
    assert list(SCHEMES["oculus"]) == visemes
    assert all(expression_weights({name: 1}) == preset(f"viseme_{name}") for name in visemes)
    emotions, visemes = "happy angry sad relaxed surprised", "aa ih ou ee oh"
    eyes = "blink blinkLeft blinkRight lookUp lookDown lookLeft lookRight"
    assert " ".join(SCHEMES["vrm"]) == f"{emotions} {visemes} {eyes} neutral"


def test_weights_add_up_and_are_linear():
    a, b = {"AU12": 0.5, "smile": 0.2}, {"jawOpen": -0.1, "viseme_aa": 2.0}
    both = expression_weights(a | b)
    separate = [expression_weights(a), expression_weights(b)]
    assert both == pytest.approx(
        {name: sum(weights.get(name, 0) for weights in separate) for name in set().union(*separate)}
    )
    assert expression_weights({"AU12": 0.5, "smile": 0.2})["mouthSmileLeft"] == pytest.approx(0.5 + 0.2 * 0.9)
    assert expression_weights({"jawOpen": 0.0, "AU1": 1, "browInnerUp": -1}) == {}
    assert preset("smile", 0.5) == {name: weight / 2 for name, weight in PRESETS["smile"].items()}


def test_bad_names_and_numbers_are_refused():
    with pytest.raises(ValueError, match="weights: no expression 'jawopen'; did you mean .*jawOpen"):
        expression_weights({"jawopen": 1})
    with pytest.raises(ValueError, match="weights: no expression 'AU12' in arkit"):
        expression_weights({"AU12": 1}, scheme="arkit")
    with pytest.raises(ValueError, match="weights: no expression 3"):
        expression_weights({3: 1})
    with pytest.raises(ValueError, match="weights: expected a finite number for AU12, got nan"):
        expression_weights({"AU12": float("nan")})
    with pytest.raises(ValueError, match="weights: expected a finite number for AU12, got '1'"):
        expression_weights({"AU12": "1"})
    with pytest.raises(ValueError, match="scheme: expected one of arkit, mediapipe, .*preset, got 'apple'"):
        expression_weights({}, scheme="apple")
    with pytest.raises(ValueError, match="name: no preset 'smle'; did you mean smile.* known: neutral, smile"):
        preset("smle")
    with pytest.raises(ValueError, match="strength: expected a finite number, got inf"):
        preset("smile", float("inf"))
