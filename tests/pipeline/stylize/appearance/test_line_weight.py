"""Lines of drawings."""

import numpy as np
import pytest

from toongeo.pipeline.stylize.appearance.line_weight import drawn_lines, lines_as_broad, without_lines

SIZE = 300.0


def crossed(width, darkness=15.0):
    """A light picture (400, 400, 3) with four lines of a breadth in px."""
    lab = np.full((400, 400, 3), [80, 5, 10], np.float32)
    for k in (60, 160, 240, 330):
        lab[k : k + width] = [darkness, 1, 2]
    return lab


@pytest.mark.parametrize("width", [3, 5, 9])
def test_the_breadth_of_lines_is_measured_at_any_size(width):
    lines = drawn_lines(crossed(width), SIZE)
    assert lines.width * SIZE == pytest.approx(width, abs=1.0)
    np.testing.assert_allclose(lines.colour, [15, 1, 2], atol=1)
    large = np.repeat(np.repeat(crossed(width), 2, axis=0), 2, axis=1)
    assert drawn_lines(large, 2 * SIZE).width == pytest.approx(lines.width, abs=0.003)


def test_what_is_broad_or_pale_is_no_line():
    assert drawn_lines(crossed(40), SIZE).width == 0
    assert drawn_lines(crossed(4, darkness=70.0), SIZE).width == 0


@pytest.mark.parametrize(("width", "wanted"), [(3, 9), (9, 3)])
def test_lines_become_as_broad_as_wanted(width, wanted):
    lab = crossed(width)
    cover = lines_as_broad(lab, drawn_lines(lab, SIZE), wanted / SIZE, SIZE)
    assert cover[:, 200].sum() / 4 == pytest.approx(wanted, abs=1.2)


def test_a_picture_without_lines_gets_those_of_its_edges():
    lab = np.full((400, 400, 3), [70, 0, 0], np.float32)
    lab[198:202, :, 0] = 55  # too faint to be drawn
    cover = lines_as_broad(lab, drawn_lines(lab, SIZE), 6 / SIZE, SIZE)
    assert cover[200, 50:350].min() == 1 and cover[100].max() == 0
    assert cover[:, 200].sum() == pytest.approx(7, abs=2.5)


def test_lines_are_taken_from_a_picture():
    lab = crossed(5)
    clean = without_lines(lab, drawn_lines(lab, SIZE), SIZE)
    assert np.abs(clean - [80, 5, 10]).max() < 8
