"""Complete or not there."""

import os
import stat

import pytest

from toongeo.io import atomic_write


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_writes_all(tmp_path):
    atomic_write({tmp_path / "a": b"1", str(tmp_path / "b"): b"2"})
    assert (tmp_path / "a").read_bytes() == b"1" and (tmp_path / "b").read_bytes() == b"2"
    assert names(tmp_path) == ["a", "b"]


def test_replaces_and_keeps_the_mode(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    path.chmod(0o640)
    atomic_write({path: b"new"})
    assert path.read_bytes() == b"new" and stat.S_IMODE(path.stat().st_mode) == 0o640


def test_new_file_has_the_usual_mode(tmp_path):
    (tmp_path / "usual").write_bytes(b"")
    atomic_write({tmp_path / "a": b""})
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_follows_a_symbolic_link(tmp_path):
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    atomic_write({tmp_path / "link": b"new"})
    assert (tmp_path / "link").is_symlink() and (tmp_path / "real").read_bytes() == b"new"


def test_longest_name(tmp_path):
    atomic_write({tmp_path / ("x" * 255): b"1"})
    assert names(tmp_path) == ["x" * 255]


@pytest.mark.parametrize("bad", ["missing/b", "file/b", "folder"])
def test_one_bad_target_leaves_nothing(tmp_path, bad):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_bytes(b"")
    (tmp_path / "a").write_bytes(b"old")
    before = names(tmp_path)
    with pytest.raises(OSError, match=f"cannot write .*{bad}: "):
        atomic_write({tmp_path / "a": b"new", tmp_path / bad: b"2", tmp_path / "c": b"3"})
    assert names(tmp_path) == before and (tmp_path / "a").read_bytes() == b"old"


@pytest.mark.parametrize(("step", "error"), [("fsync", OSError), ("replace", OSError), ("fsync", KeyboardInterrupt)])
def test_failure_midway(tmp_path, monkeypatch, step, error):
    calls = []

    def fail(*_):
        calls.append(1)
        if len(calls) == 2:
            raise error(28, "No space left on device") if error is OSError else error

    actual = getattr(os, step)
    monkeypatch.setattr(os, step, lambda *a: fail(*a) or actual(*a))
    with pytest.raises(error, match="cannot write .*b: No space left" if error is OSError else None):
        atomic_write({tmp_path / "a": b"1", tmp_path / "b": b"2"})
    assert names(tmp_path) == (["a"] if step == "replace" else [])


def test_content_that_is_not_bytes(tmp_path):
    with pytest.raises(TypeError):
        atomic_write({tmp_path / "a": "text"})
    assert names(tmp_path) == []


def test_a_pipe_stays_one_and_gets_the_content(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OSError, match="cannot write .*pipe: "):  # nobody reads
        atomic_write({tmp_path / "pipe": b"lost", tmp_path / "a": b"1"})
    assert names(tmp_path) == ["pipe"]
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    try:
        atomic_write({tmp_path / "pipe": b"read", tmp_path / "a": b"1"})
        assert os.read(reader, 99) == b"read" and (tmp_path / "a").read_bytes() == b"1"
    finally:
        os.close(reader)
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode) and names(tmp_path) == ["a", "pipe"]


def test_a_device_stays_one(tmp_path):
    (tmp_path / "link").symlink_to(os.devnull)
    atomic_write({tmp_path / "link": b"gone"})
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode) and (tmp_path / "link").is_symlink()
    if os.path.exists("/dev/full"):
        (tmp_path / "full").symlink_to("/dev/full")
        with pytest.raises(OSError, match="cannot write .*full: No space left"):
            atomic_write({tmp_path / "full": b"no", tmp_path / "a": b"1"})
        assert names(tmp_path) == ["full", "link"]


@pytest.mark.parametrize("bad", [5, None, "a\0b", "a\ud800"])
def test_what_is_no_name(tmp_path, bad):
    with pytest.raises(ValueError, match="path: expected the name of a file, got"):
        atomic_write({bad if not isinstance(bad, str) else tmp_path / bad: b"1"})
    assert names(tmp_path) == []
