"""Records whatever happens to workers."""

import os
import signal
from concurrent.futures import Future
from pathlib import Path

import pytest

from toongeo.batch.engines.local_engines import LokyEngine, SerialEngine, ThreadEngine
from toongeo.batch.picture_jobs import PictureJob
from toongeo.batch.streamed_records import streamed_records
from toongeo.batch.work.attempts import Attempts


def jobs(folder, count):
    return [
        PictureJob(f"{k:02}", Path(), None, folder / f"{k}.out", Path(), folder / f"{k}.mark") for k in range(count)
    ]


def work(job):
    """As PictureWork: marks, and a record; 03 always kills its worker, 05 only once."""
    attempts = Attempts(job.mark)
    if attempts.is_hopeless:
        return {"picture": job.name, "status": "killed"}
    attempts.begin()
    if job.name == "03" or (job.name == "05" and not job.output.exists()):
        job.output.write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    attempts.end()
    return {"picture": job.name, "status": "done", "worker": os.getpid()}


@pytest.mark.parametrize("engine", [SerialEngine, lambda: ThreadEngine(2)])
def test_all_are_done_once(tmp_path, engine):
    engine = engine()
    found = list(streamed_records(engine, _plain, jobs(tmp_path, 9)))
    engine.close(now=False)
    assert sorted(record["picture"] for record in found) == [f"{k:02}" for k in range(9)]


def _plain(job):
    return {"picture": job.name, "status": "done"}


def test_a_picture_that_kills_its_worker_is_tried_twice_and_costs_no_other(tmp_path):
    engine = LokyEngine(2)
    try:
        found = {record["picture"]: record["status"] for record in streamed_records(engine, work, jobs(tmp_path, 8))}
    finally:
        engine.close(now=True)
    assert found == {f"{k:02}": "killed" if k == 3 else "done" for k in range(8)}


class Broken:
    """An engine none of whose workers begins."""

    workers = 2
    restarts = 0

    def submit(self, work, *arguments):
        if self.restarts % 2:
            raise RuntimeError("the pool is shut down")
        future = Future()
        future.set_exception(OSError("no room"))
        return future

    def restart(self):
        self.restarts += 1


def test_workers_that_never_begin_are_given_up(tmp_path):
    engine = Broken()
    found = list(streamed_records(engine, work, jobs(tmp_path, 4)))
    assert sorted(record["picture"] for record in found) == ["00", "01", "02", "03"]
    assert {record["status"] for record in found} == {"killed"} and "no worker could begin it" in found[0]["error"]
