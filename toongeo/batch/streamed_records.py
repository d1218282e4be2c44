"""Records of pictures as they come, whatever happens to the workers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from itertools import chain
from typing import Any

from toongeo.batch.engines.engine import Engine
from toongeo.batch.picture_jobs import PictureJob
from toongeo.batch.work.attempts import Attempts

__all__ = ["streamed_records"]

_MOST_LOSSES = 3  # of a picture that no worker has even begun

_Record = dict[str, Any]
_Lost = tuple[PictureJob, BaseException]


def streamed_records(
    engine: Engine, work: Callable[[PictureJob], _Record], jobs: Iterable[PictureJob]
) -> Iterator[_Record]:
    """A record of each job, in the order in which they end.

    Where a worker is lost, what it had begun is suspected and done again at the end, one picture at a time: the one
    that costs a second worker is given up.
    """
    losses: Counter[str] = Counter()
    suspects: list[PictureJob] = []
    waiting: Iterator[PictureJob] = iter(jobs)
    while True:
        lost: list[_Lost] = []
        # A few wait, so that no worker does; of millions no more are held.
        yield from _until_lost(engine, work, waiting, 2 * engine.workers - 1, lost)
        if not lost:
            break
        engine.restart()
        again = []
        for job, error in lost:
            losses[job.name] += 1
            if Attempts(job.mark).begun:
                suspects.append(job)
            elif losses[job.name] < _MOST_LOSSES:
                again.append(job)
            else:
                yield {"picture": job.name, "status": "killed", "error": f"no worker could begin it ({error!r})"[:500]}
        waiting = chain(again, waiting)
    for job in suspects:
        lost = []
        yield from _until_lost(engine, work, iter([job]), 1, lost)
        if lost:
            engine.restart()
            yield work(job) if Attempts(job.mark).is_hopeless else _unknown(*lost[0])


def _until_lost(
    engine: Engine,
    work: Callable[[PictureJob], _Record],
    jobs: Iterator[PictureJob],
    most: int,
    lost: list[_Lost],
) -> Iterator[_Record]:
    """Records until the jobs are at an end, or some are lost."""
    running: dict[Future[_Record], PictureJob] = {}
    try:
        while True:
            while not lost and len(running) < most and (job := next(jobs, None)) is not None:
                running[_submitted(engine, work, job)] = job
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                job = running.pop(future)
                if (error := future.exception()) is None:
                    yield future.result()
                else:
                    lost.append((job, error))
    finally:
        for future in running:
            future.cancel()


def _submitted(engine: Engine, work: Callable[[PictureJob], _Record], job: PictureJob) -> Future[_Record]:
    """A call; one that has failed already where the workers are gone."""
    try:
        return engine.submit(work, job)
    except RuntimeError as error:  # the pool is broken, or shut down
        failed: Future[_Record] = Future()
        failed.set_exception(error)
        return failed


def _unknown(job: PictureJob, error: BaseException) -> _Record:
    return {"picture": job.name, "status": "killed", "error": f"{type(error).__name__}: {error}"[:500]}
