"""Fits come back from their files bit for bit, and nothing in a file is executed."""

import dataclasses
import json
import pickle

import numpy as np
import pytest

from toongeo.pipeline import FaceFit, fit_3dmm
from toongeo.pipeline.fit.face_fit import PhotometricReport
from toongeo.render import PerspectiveCamera


@pytest.fixture
def fit(cartoon):
    """With all that a fit can have."""
    img, points = cartoon("blue_girl")
    rng = np.random.default_rng(0)
    found = fit_3dmm(img, points)
    report = PhotometricReport(0.3, 0.2, 0.1, 0.9, "XTOL_REACHED", 3, 40, 1.5)
    return dataclasses.replace(
        found, albedo=rng.standard_normal(9), light=rng.standard_normal((9, 3)), photometric=report
    )


def same(a, b):
    for field in dataclasses.fields(a):
        first, second = getattr(a, field.name), getattr(b, field.name)
        if isinstance(first, np.ndarray):
            assert first.dtype == second.dtype
            np.testing.assert_array_equal(first, second)
        elif field.name == "camera":
            assert type(first) is type(second)
            same(first, second)
        else:
            assert first == second, field.name


@pytest.mark.parametrize("suffix", [".json", ".npz"])
def test_a_fit_comes_back(fit, tmp_path, suffix):
    path = tmp_path / f"fit{suffix}"
    fit.save(path)
    again = FaceFit.load(path)
    same(fit, again)
    np.testing.assert_array_equal(again.vertices, fit.vertices)
    again.save(tmp_path / f"again{suffix}")
    same(FaceFit.load(tmp_path / f"again{suffix}"), fit)


@pytest.mark.parametrize("suffix", [".json", ".npz"])
def test_parts_that_are_not_there_and_other_cameras(fit, tmp_path, suffix):
    camera = PerspectiveCamera(800.0, np.eye(3), np.array([0.0, 0, -500]), np.array([100.0, 120]))
    bare = dataclasses.replace(fit, albedo=None, light=None, photometric=None, camera=camera)
    bare.save(tmp_path / f"fit{suffix}")
    same(FaceFit.load(tmp_path / f"fit{suffix}"), bare)


def test_the_mapping_is_plain(fit):
    again = json.loads(json.dumps(fit.to_dict()))
    assert again == fit.to_dict() and len(again["identity"]) == len(fit.identity)


def test_a_camera_of_ones_own_is_refused(fit, tmp_path):
    class Mine:
        pass

    with pytest.raises(ValueError, match="camera: expected one of PerspectiveCamera, .*, got Mine"):
        dataclasses.replace(fit, camera=Mine()).save(tmp_path / "fit.npz")
    assert not list(tmp_path.iterdir())


def test_files_that_are_no_fits(fit, tmp_path, artist):
    with pytest.raises(ValueError, match="path: expected a name that ends in .json or .npz"):
        fit.save(tmp_path / "fit.pkl")
    fit.save(tmp_path / "fit.npz")
    other = dataclasses.replace(artist, mean=artist.mean + 1)
    with pytest.raises(ValueError, match="model: expected the model that the fit was made with, got another"):
        FaceFit.load(tmp_path / "fit.npz", model=other)
    content = (tmp_path / "fit.npz").read_bytes()
    evil = {"a.json": b"{}", "b.json": b"[1]", "c.json": b"no", "d.npz": content[:-40], "e.npz": pickle.dumps([1])}
    for name, text in evil.items():
        (tmp_path / name).write_bytes(text)
        with pytest.raises(ValueError, match="path: expected a fit that was saved"):
            FaceFit.load(tmp_path / name)
    np.savez(tmp_path / "f.npz", identity=np.array([object()], dtype=object), **{"rest.json": np.zeros(1, np.uint8)})
    with pytest.raises(ValueError, match="path: expected a fit that was saved"):
        FaceFit.load(tmp_path / "f.npz")
    with pytest.raises(OSError, match="none.json"):
        FaceFit.load(tmp_path / "none.json")
