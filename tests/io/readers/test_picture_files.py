import pytest

from toongeo.io.readers.picture_files import pictures_in


def test_pictures_by_name_without_hidden_files(tmp_path):
    """A Mac writes ``._a.jpg`` beside ``a.jpg``."""
    for name in ("b.PNG", "a.jpg", "._a.jpg", ".DS_Store", "a.pts"):
        (tmp_path / name).write_bytes(b"")
    (tmp_path / "folder.png").mkdir()
    assert [path.name for path in pictures_in(tmp_path)] == ["a.jpg", "b.PNG"]


def test_none_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"inputs: expected pictures \(.png, .jpg, .*\), got none in"):
        pictures_in(tmp_path, "inputs")
