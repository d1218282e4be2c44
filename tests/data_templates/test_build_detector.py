"""Pictures and steps of the training of the landmark detector, on a few renders."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

from detector import samples as samples_of
from detector.samples import KINDS, SIZE_PX, rendered_samples, with_even_jaw
from detector.strange_samples import strange_samples

from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline.landmarks.search.detector_file import detector_arrays


@pytest.fixture(scope="module")
def few():
    """Two pictures of each of eight heads."""
    return rendered_samples(8, 8, "every", 1)


def silent(text, **options):
    pass


def test_samples_do_not_depend_on_how_they_are_shared_out(monkeypatch):
    one = rendered_samples(7, 2, "usual", 1)
    monkeypatch.setattr(samples_of, "_CHUNK", 1)
    two = rendered_samples(7, 2, "usual", 1)
    assert one.grey.tobytes() == two.grey.tobytes() and one.grey.shape == (4, 256, 256)
    np.testing.assert_array_equal(one.landmarks, two.landmarks)


def test_samples_come_back_from_the_cache(tmp_path):
    one = rendered_samples(7, 1, "usual", 1, tmp_path)
    (kept,) = tmp_path.iterdir()
    stamp = kept.stat().st_mtime_ns
    two = rendered_samples(7, 1, "usual", 1, tmp_path)
    assert one.grey.tobytes() == two.grey.tobytes() and kept.stat().st_mtime_ns == stamp


def test_a_mix_may_leave_heads_out():
    every, drawn = rendered_samples(7, 3, "every", 1), rendered_samples(7, 3, "drawn", 1)
    person = every.kinds == KINDS.index("person")
    assert 0 < person.sum() < len(person)
    np.testing.assert_array_equal(drawn.grey, every.grey[~person])


@pytest.mark.parametrize("kind", ["figure", "exaggerated"])
def test_heads_that_no_person_has_show_their_points(kind):
    for seed in range(2):
        styles, scene = samples_of._scene(np.random.default_rng([9, seed]), kind)
        assert len(styles) == 2 and scene.picture.shape == (SIZE_PX, SIZE_PX, 3)
        assert (np.abs(scene.landmarks - SIZE_PX / 2) < SIZE_PX / 2 + 10).all()
        middles = [scene.landmarks[rows].mean(0)[1] for rows in (slice(36, 48), slice(31, 36), slice(48, 68))]
        assert (np.diff([*middles, scene.landmarks[8, 1]]) > 0).all()  # eyes, nose, mouth, chin


def test_a_figure_has_its_eyes_and_mouth_where_its_points_are():
    """What lies within the lids is not the skin that lies around them."""
    from figures import random_figure

    told = []
    for seed in range(6):
        scene = random_figure(np.random.default_rng([3, seed]))
        for rows in (slice(36, 42), slice(42, 48), slice(48, 60)):
            ring = scene.landmarks[rows]
            middle = ring.mean(0)
            around = np.vstack([middle + (ring - middle) * s for s in (0.3, 0.6, 1.0)]).round().astype(int)
            colours = scene.picture[around[:, 1].clip(0, 255), around[:, 0].clip(0, 255)]
            told.append(np.ptp(colours, axis=0).max() > 25)
    assert np.mean(told) > 0.8  # others are dark or behind dark glasses


def test_a_jaw_is_even_between_its_ends_and_the_chin():
    straight = np.zeros((68, 2))
    straight[:17, 0] = np.append(np.arange(9) ** 2, 64 + np.arange(1, 9))
    even = with_even_jaw(straight)
    np.testing.assert_allclose(even[:17, 0], np.append(np.arange(9) * 8, 64 + np.arange(1, 9)))
    np.testing.assert_allclose(with_even_jaw(even), even, atol=1e-9)


def test_strange_samples_are_others_and_the_same_twice(few):
    one, two = strange_samples(few, 1), strange_samples(few, 1)
    assert one.grey.tobytes() == two.grey.tobytes()
    changed = [(a != b).mean() > 0.1 for a, b in zip(one.grey, few.grey, strict=True)]
    assert 3 <= sum(changed) < len(changed)


def test_a_small_cascade_learns_and_is_the_same_twice(few, monkeypatch):
    from detector import linear, train_cascade, train_parts

    monkeypatch.setattr(linear, "_RIDGES", (0.1,))
    monkeypatch.setattr(train_cascade, "STAGES", train_cascade.STAGES[:1])
    said = []
    one, two = (train_cascade.train_cascade(few, few, 1, say=lambda text, **k: said.append(text)) for _ in range(2))
    assert float(said[0].split()[-1]) < 0.1  # the mean shape has 0.2 and more
    for a, b in zip(one.stages, two.stages, strict=True):
        assert a.weights.tobytes() == b.weights.tobytes() and a.axes.tobytes() == b.axes.tobytes()
    np.testing.assert_allclose((one.shape - 80)[MIRROR] * [-1, 1], one.shape - 80, atol=1e-6)

    monkeypatch.setattr(train_parts, "_STAGES", train_parts._STAGES[:1])
    said.clear()
    nose, mouth = train_parts.train_parts(
        few, few, one, 1, train_parts.PARTS[2:4], say=lambda text, **k: said.append(text)
    )
    before, after = (float(word) for word in said[1].split()[-3::2])
    assert len(nose.rows) == 9 and len(mouth.rows) == 20 and after < before


@pytest.mark.slow
def test_the_whole_course_goes_on_where_it_was_stopped(few, tmp_path, monkeypatch):
    """A toy: every step runs, and one that is read from the cache gives the same bytes."""
    import build_detector
    from detector import linear, train_boxes, train_cascade, train_parts

    monkeypatch.setattr(linear, "_RIDGES", (0.1,))
    monkeypatch.setattr(train_cascade, "STAGES", train_cascade.STAGES[:2])
    monkeypatch.setattr(train_parts, "_STAGES", train_parts._STAGES[:1])
    monkeypatch.setattr(train_boxes, "_SEARCHED", 4)
    monkeypatch.setattr(build_detector, "CLUTTER", ())
    monkeypatch.setattr(build_detector, "CALIBRATION", ())
    monkeypatch.setattr(build_detector, "rendered_samples", lambda *rest: few)
    size = build_detector._Size(8, 8, 8, 8, 4, 2, 2, 2)
    one, two = (detector_arrays(build_detector.trained_parts(size, 1, tmp_path, silent)) for _ in range(2))
    assert {path.stem for path in tmp_path.iterdir()} == {"boxes", "cascade", "parts", "photo_parts", "verifier"}
    other = detector_arrays(build_detector.trained_parts(size, 1, None, silent))
    for name, array in one.items():
        assert array.tobytes() == two[name].tobytes() == other[name].tobytes(), name
