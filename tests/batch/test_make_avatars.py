"""Batches of real pictures: small, bare and few."""

import hashlib
import json
import shutil
import signal
import subprocess
import sys
import time
import types

import numpy as np
import pytest

from tests.conftest import ROOT
from toongeo.app.cli import main
from toongeo.batch import BatchLimits, BatchOptions, make_avatars, read_manifest
from toongeo.batch.engines import ray_engine

PORTRAITS = ROOT / "examples" / "portraits"
SMALL = BatchOptions(making={"texture_size": 64, "hair": False}, saving={"animation": None})


def small_pictures(folder, count=1, broken=()):
    """Pictures that are cheap to make heads of, and some that are none."""
    folder.mkdir(parents=True, exist_ok=True)
    for k in range(count):
        shutil.copy(PORTRAITS / "moustache_man.png", folder / f"p{k}.png")
        shutil.copy(PORTRAITS / "moustache_man.pts", folder / f"p{k}.pts")
    for name, content in broken:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def digests(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.rglob("*.glb"))}


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """A folder of two pictures and two that are none, and what a serial batch makes of it."""
    base = tmp_path_factory.mktemp("batch")
    broken = [("bad.png", b"no picture"), ("deep/empty.jpg", b"")]
    small_pictures(base / "in", 1, broken)
    result = make_avatars(base / "in", base / "out", options=SMALL, backend="serial")
    return base, result


def test_good_pictures_are_made_and_bad_ones_are_listed(serial):
    base, result = serial
    assert result.statuses == {"done": 1, "refused": 2} and result.failed == 2 and result.skipped == 0
    records = read_manifest(base / "out")
    assert sorted(records) == ["bad.png", "deep/empty.jpg", "p0.png"]
    good, bad = records["p0.png"], records["bad.png"]
    assert good["output_sha256"] == digests(base / "out")["p0.glb"] and good["error"] is None
    assert good["seconds"]["total"] > 0 and good["metrics"]["aligned"]["total"] < 0.01 and good["peak_mb"] > 50
    assert "expected a picture" in bad["error"] and bad["input"] and "output_sha256" not in bad
    names = sorted(path.relative_to(base / "out").as_posix() for path in (base / "out").rglob("*"))
    assert names == ["manifest.jsonl", "p0.glb", "report.html", "thumbnails", "thumbnails/p0.jpg"]
    head = json.loads((base / "out" / "manifest.jsonl").read_text().splitlines()[0])
    assert head["digest"] == good["options"] == SMALL.digest() and "numpy" in head["versions"]
    page = (base / "out" / "report.html").read_text()
    assert "thumbnails/p0.jpg" in page and "deep/empty.jpg" in page and "<script" not in page


def test_resuming_does_nothing_twice_and_notices_changes(serial, tmp_path):
    base, _ = serial
    shutil.copytree(base, tmp_path / "copy")
    folder, output = tmp_path / "copy" / "in", tmp_path / "copy" / "out"
    with pytest.raises(ValueError, match="output: expected a folder without a batch, but .*resume=True"):
        make_avatars(folder, output, options=SMALL, backend="serial")
    made = (output / "p0.glb").stat().st_mtime_ns
    assert make_avatars(folder, output, options=SMALL, backend="serial", resume=True).skipped == 3
    assert (output / "p0.glb").stat().st_mtime_ns == made
    (folder / "bad.png").write_bytes(b"still no picture")
    assert make_avatars(folder, output, options=SMALL, backend="serial", resume=True).skipped == 2
    (output / "p0.glb").write_bytes(b"cut")
    assert make_avatars(folder, output, options=SMALL, backend="serial", resume=True).skipped == 2
    assert digests(output) == digests(base / "out")


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["loky", "threading", "dask"])
def test_every_backend_writes_the_same_bytes(serial, tmp_path, backend):
    base, _ = serial
    if backend == "dask":
        pytest.importorskip("distributed", reason="needs the extra `cluster`")
    result = make_avatars(base / "in", tmp_path / "out", options=SMALL, backend=backend, workers=2)
    assert result.statuses == {"done": 1, "refused": 2}
    assert digests(tmp_path / "out") == digests(base / "out")


def test_the_time_of_a_picture_is_bounded(tmp_path):
    folder, output, limits = small_pictures(tmp_path / "in"), tmp_path / "out", BatchLimits(0.2, None)
    result = make_avatars(folder, output, options=SMALL, backend="serial", limits=limits)
    assert result.statuses == {"over time": 1} and digests(output) == {}
    again = make_avatars(folder, output, options=SMALL, backend="serial", limits=limits, resume=True)
    assert again.skipped == 0  # it may fare better another time


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="memory is bounded on Linux only")
def test_the_memory_of_a_picture_is_bounded(tmp_path):
    folder, output = small_pictures(tmp_path / "in"), tmp_path / "out"
    result = make_avatars(folder, output, options=SMALL, workers=1, limits=BatchLimits(None, 20))
    assert result.statuses == {"over memory": 1} and digests(output) == {}


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_batch_leaves_whole_files_and_goes_on(tmp_path, number):
    folder, output = small_pictures(tmp_path / "in", 5), tmp_path / "out"
    command = [sys.executable, "-m", "toongeo", "batch", folder, "-o", output, "--texture-size", "64", "--no-hair"]
    process = subprocess.Popen(
        [*map(str, command), "--workers", "1"], cwd=ROOT, stderr=subprocess.PIPE, start_new_session=True
    )
    end = time.monotonic() + 240
    while not (output / "p0.glb").exists() and process.poll() is None:
        assert time.monotonic() < end
        time.sleep(0.05)
    process.send_signal(number)
    assert process.wait(60) == 130 and b"Traceback" not in process.stderr.read()
    process.stderr.close()
    assert not list(output.rglob("*.tmp")) and not (output / ".toongeo-batch").exists()
    done = {name for name, record in read_manifest(output).items() if record["status"] == "done"}
    assert len(done) < 5
    assert main([*map(str, command[3:]), "--resume", "--backend", "serial"]) == 0
    assert sorted(digests(output)) == [f"p{k}.glb" for k in range(5)] and len(set(digests(output).values())) == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"backend": "celery"}, "backend: expected one of loky"),
        ({"scheduler": "tcp://x"}, "scheduler: expected backend 'dask'"),
        ({"workers": 0}, "workers: expected an integer > 0, got 0"),
        ({"workers": True}, "workers: expected an integer > 0, got True"),
        ({"backend": "threading", "limits": BatchLimits()}, "limits: expected no memory_mb with backend 'threading'"),
        ({"backend": "threading", "limits": BatchLimits(9, None)}, "limits: expected no seconds with backend 'thr"),
        ({"backend": "serial", "limits": BatchLimits()}, "limits: expected no memory_mb with backend 'serial'"),
    ],
)
def test_bad_arguments_leave_nothing(tmp_path, options, message):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.png").write_bytes(b"")
    with pytest.raises(ValueError, match=message):
        make_avatars(tmp_path / "in", tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def test_options_that_are_none(tmp_path):
    with pytest.raises(ValueError, match="quantize: no option of .obj"):
        BatchOptions(suffix=".obj", saving={"quantize": True})
    with pytest.raises(ValueError, match="model: expected a number, a text or a truth value, got ndarray"):
        BatchOptions(making={"model": np.zeros(3)})
    assert main(["batch", str(tmp_path), "-o", str(tmp_path / "out")]) == 2
    assert main(["batch", str(tmp_path / "none"), "-o", str(tmp_path / "out")]) == 2


def test_names_that_differ_in_their_ends_get_files_of_their_own(tmp_path):
    from toongeo.batch.picture_jobs import picture_jobs

    for name in ("a.png", "a.jpg", "b.png", "sub/b.png"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thumbnail.jpg").write_bytes(b"")
    found = [
        job.output.relative_to(tmp_path / "out").as_posix() for job in picture_jobs(tmp_path, tmp_path / "out", ".glb")
    ]
    assert found == ["a.jpg.glb", "a.png.glb", "b.glb", "sub/b.glb"]


def test_ray_is_used_as_it_asks(monkeypatch):
    """With a stand-in: ray itself is not among what tests need."""
    calls = []

    class Remote:
        def __init__(self, work):
            self.work = work

        def remote(self, *arguments):
            engine = __import__("concurrent.futures").futures.Future()
            engine.set_result(self.work(*arguments))
            return types.SimpleNamespace(future=lambda: engine)

    ray = types.SimpleNamespace(
        init=lambda **options: calls.append(options),
        remote=lambda **options: lambda work: calls.append(options) or Remote(work),
        shutdown=lambda: calls.append("shutdown"),
    )
    monkeypatch.setitem(sys.modules, "ray", ray)
    engine = ray_engine.RayEngine(2)
    assert engine.submit(abs, -3).result() == 3
    engine.close(now=True)
    assert calls[0]["num_cpus"] == 2 and calls[1] == {"max_retries": 0} and calls[-1] == "shutdown"
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match="pip install ray"):
        ray_engine.RayEngine(2)
