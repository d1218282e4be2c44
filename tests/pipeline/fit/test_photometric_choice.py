from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.pipeline.fit.photometric_choice import photometric_choice
from toongeo.pipeline.landmarks.looks_photographed import looks_photographed


@pytest.mark.parametrize("name", CARTOONS)
def test_a_photograph_of_a_person_is_told_from_drawings(name, cartoon, fits):
    assert (photometric_choice(cartoon(name)[0], fits(name)) is not None) == (name == "astronaut")


@pytest.mark.parametrize("name", ["einstein", "image_0010", "takeo"])
def test_portraits_are_of_people(name, shared):
    from toongeo import fit_3dmm
    from toongeo.io import read_image, read_landmarks

    folder = shared / "data" / "portraits"
    img = read_image(next(path for path in folder.glob(f"{name}.*") if path.suffix != ".pts"))
    assert photometric_choice(img, fit_3dmm(img, read_landmarks(folder / f"{name}.pts"))) is not None


def test_neither_a_face_that_the_model_misses_nor_one_without_colours(cartoon, fits):
    img, fit = cartoon("astronaut")[0], fits("astronaut")
    for rms in (4.1, np.nan):
        assert photometric_choice(img, replace(fit, report=replace(fit.report, rms_percent=rms))) is None
    bare = replace(fit.model, albedo_mean=np.empty(0), albedo=np.empty(0))
    assert photometric_choice(img, replace(fit, model=bare)) is None


def test_size_and_tilt_make_no_difference(cartoon):
    img, points = cartoon("astronaut")
    assert looks_photographed(img[::2, ::2], (points - 0.5) / 2 + 0.25)
    turned = np.column_stack([points[:, 1], img.shape[1] - 1 - points[:, 0]])
    assert looks_photographed(np.ascontiguousarray(np.rot90(img)), turned)
