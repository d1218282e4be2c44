"""Lines of the manifest."""

import pytest

from toongeo.batch.manifest import append_record, read_manifest


def test_the_latest_line_of_each_picture_counts(tmp_path):
    path = tmp_path / "manifest.jsonl"
    for status in ("killed", "done"):
        append_record(path, {"picture": "a.png", "status": status})
    append_record(path, {"batch": "folder"})
    append_record(path, {"picture": "b.png", "status": "refused"})
    assert {name: record["status"] for name, record in read_manifest(tmp_path).items()} == {
        "a.png": "done",
        "b.png": "refused",
    }
    assert len(path.read_text().splitlines()) == 4


def test_a_line_that_was_cut_off_spoils_no_other(tmp_path):
    path = tmp_path / "manifest.jsonl"
    append_record(path, {"picture": "a.png", "status": "done"})
    with path.open("ab") as stream:
        stream.write(b'{"picture": "b.png", "stat')
    append_record(path, {"picture": "c.png", "status": "done"})
    assert sorted(read_manifest(path)) == ["a.png", "c.png"]
    path.write_bytes(path.read_bytes() + b"\xff\n[]\n5\n" + b"[" * 10_000 + b'\n{"picture": 5}\n')
    assert sorted(read_manifest(path)) == ["a.png", "c.png"]


def test_numbers_that_json_has_not_are_refused(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        append_record(tmp_path / "m", {"picture": "a", "error": float("nan")})
    assert not (tmp_path / "m").exists()
    with pytest.raises(FileNotFoundError):
        read_manifest(tmp_path)
