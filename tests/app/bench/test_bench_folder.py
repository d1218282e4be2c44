import shutil

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo.app.bench.bench_folder import bench_folder
from toongeo.io import read_landmarks


def test_pictures_by_name_with_either_kind_of_landmarks(folder):
    found = bench_folder(folder)
    assert [picture.name for picture in found] == ["blue_girl.png", "moustache_man.png"]
    for picture in found:
        img, landmarks = picture.read()
        assert img.shape[2] == 3
        truth = read_landmarks(PORTRAITS / picture.picture.with_suffix(".pts").name)
        np.testing.assert_allclose(landmarks, truth, atol=1e-6)


def test_pts_wins_over_txt_and_other_files_do_not_matter(folder):
    (folder / "blue_girl.txt").write_text("nonsense")
    (folder / "readme.md").write_text("words")
    assert bench_folder(folder)[0].landmarks.suffix == ".pts"


def test_what_is_missing_is_named(folder, tmp_path):
    with pytest.raises(NotADirectoryError, match="folder: expected a folder of pictures, got .*none"):
        bench_folder(tmp_path / "none")
    (tmp_path / "empty").mkdir()
    with pytest.raises(ValueError, match="folder: expected pictures .* got none in .*empty"):
        bench_folder(tmp_path / "empty")
    shutil.copy(folder / "blue_girl.png", folder / "blue_girl.webp")
    with pytest.raises(ValueError, match=r"folder: expected one picture .* got blue_girl.png and blue_girl.webp"):
        bench_folder(folder)
    (folder / "blue_girl.webp").unlink()
    (folder / "blue_girl.pts").unlink()
    with pytest.raises(ValueError, match=r"folder: expected landmarks .* got none for blue_girl.png"):
        bench_folder(folder)
