"""The pictures of a batch."""

import os

import pytest

from toongeo.batch.batch_options import BatchOptions
from toongeo.batch.finished import is_finished
from toongeo.batch.picture_jobs import input_digest, picture_jobs


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes have no names here")
def test_a_pipe_among_the_pictures_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.png")
    (job,) = picture_jobs(tmp_path, tmp_path / "heads", ".glb")
    with pytest.raises(ValueError, match=r"expected a file, but .*a\.png is a device or a pipe"):
        input_digest(job)
    assert not is_finished(job, {"status": "refused"}, BatchOptions())


def test_hidden_files_are_no_pictures(tmp_path):
    for name in ("a.png", "._a.png", ".b.jpg"):
        (tmp_path / name).write_bytes(b"")
    assert [job.name for job in picture_jobs(tmp_path, tmp_path / "heads", ".glb")] == ["a.png"]
