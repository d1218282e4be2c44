import sys
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.io import read_image, read_landmarks
from toongeo.pipeline import landmark_evidence
from toongeo.pipeline.landmarks.landmark_evidence import CUES

sys.path.insert(0, str(Path(__file__).parents[3] / "data_templates" / "build"))

import landmark_evidence as trainer


def unit(points):
    return np.linalg.norm(points[36] - points[45])


def test_the_examples_are_plausible(cartoon):
    for name in CARTOONS:
        found = landmark_evidence(*cartoon(name))
        assert found.is_plausible and found.chance > 0.5 and not found.has_dark_glasses, name


def test_so_are_the_portraits(shared):
    for path in sorted((shared / "data" / "portraits").glob("*.pts")):
        picture = next(p for p in path.parent.glob(f"{path.stem}.*") if p.suffix != ".pts")
        found = landmark_evidence(read_image(picture), read_landmarks(path))
        assert found.is_plausible and not found.has_dark_glasses, path.stem


def test_renders_with_their_own_points_and_with_points_that_are_off(render):
    """Off by half an outer-eye distance, each another way; one of 24 judgements may fail."""
    renders = [render(k, kind) for kind in ("person", "caricature", "cartoon") for k in range(4)]
    wrong = 0
    for k, one in enumerate(renders):
        off = unit(one.landmarks) / 2 * np.array([np.cos(k), np.sin(k)])
        wrong += not landmark_evidence(one.picture, one.landmarks).is_plausible
        wrong += landmark_evidence(one.picture, one.landmarks + off).is_plausible
    assert wrong <= 1


def test_points_of_another_picture_are_not(cartoon):
    """Each picture with every other's points in its own frame, unless both faces lie in nearly one place."""
    tried = 0
    for name in CARTOONS:
        img, own = cartoon(name)
        for other in CARTOONS:
            shape, points = cartoon(other)[0].shape, cartoon(other)[1]
            points = points * [img.shape[1] / shape[1], img.shape[0] / shape[0]]
            if np.linalg.norm(points - own, axis=1).mean() > 0.5 * unit(own):
                assert not landmark_evidence(img, points).is_plausible, (name, other)
                tried += 1
    assert tried > 10


@pytest.mark.parametrize("level", [0, 120, 255])
def test_nothing_is_to_be_seen_in_a_blank_picture(cartoon, level):
    img, points = cartoon("blue_girl")
    found = landmark_evidence(np.full_like(img, level), points)
    assert found.is_blank and not found.is_plausible
    noise = np.random.default_rng(0).normal(level, 1, img.shape).clip(0, 255).astype(np.uint8)
    assert landmark_evidence(noise, points).is_blank


def test_size_and_turn_of_the_picture_do_not_matter(cartoon):
    img, points = cartoon("blue_girl")
    whole = landmark_evidence(img, points)
    turned = landmark_evidence(np.ascontiguousarray(np.rot90(img, 2)), [img.shape[1] - 1, img.shape[0] - 1] - points)
    twice = landmark_evidence(np.repeat(np.repeat(img, 2, 0), 2, 1), 2 * points + 0.5)
    np.testing.assert_allclose(turned.cues, whole.cues, atol=0.02)
    np.testing.assert_allclose(twice.cues, whole.cues, atol=0.1)


def test_missing_points_hardly_matter(cartoon):
    img, points = cartoon("blue_girl")
    some = np.where(np.arange(68)[:, None] < 8, np.nan, points)
    assert landmark_evidence(img, some).is_plausible
    with pytest.raises(ValueError, match="landmarks: expected at least 6 points"):
        landmark_evidence(img, np.where(np.arange(68)[:, None] < 63, np.nan, points))


def test_points_far_outside_are_no_error(cartoon):
    img, points = cartoon("blue_girl")
    assert not landmark_evidence(img, points + 5000).is_plausible
    assert not landmark_evidence(img[:1, :1], points).is_plausible


def test_every_cue_says_more_for_the_right_points(cartoon):
    """In the mean over the examples, against points shifted by half an outer-eye distance."""
    difference = []
    for name in CARTOONS:
        img, points = cartoon(name)
        right, wrong = (landmark_evidence(img, q).cues for q in (points, points + [0, 0.5 * unit(points)]))
        difference.append(right - wrong)
    assert (np.mean(difference, 0)[: len(CUES) - 1] > 0).all()


def test_the_training_makes_the_same_bytes_twice(tmp_path):
    for name in ("a.csv", "b.csv"):
        trainer.write_weights(3, tmp_path / name)
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    assert trainer.OUT.read_text(encoding="utf-8").startswith(trainer.HEADER)


def test_the_regression_finds_its_optimum(rng):
    cues = np.column_stack([rng.normal(size=(60, len(CUES) - 1)), np.ones(60)])
    right = cues[:, 0] + 0.3 * rng.normal(size=60) > 0
    weights = trainer.trained(cues, right)
    share = 1 / (1 + np.exp(-cues @ weights))
    slope = cues.T @ (share - right) + trainer.RIDGE * weights * (np.array(CUES) != "constant")
    np.testing.assert_allclose(slope, 0, atol=1e-3)
