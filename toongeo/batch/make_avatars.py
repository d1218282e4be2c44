"""A rigged head of every picture of a folder."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from threadpoolctl import threadpool_limits

from toongeo.batch.batch_options import BatchLimits, BatchOptions
from toongeo.batch.batch_run import BatchRun, interruptible, run_head
from toongeo.batch.engines.begun_engine import Backend, begun_engine, check_backend
from toongeo.batch.finished import is_finished, remove_leftovers
from toongeo.batch.manifest import MANIFEST, append_record, read_manifest
from toongeo.batch.picture_jobs import picture_jobs
from toongeo.batch.report_page import REPORT, write_report
from toongeo.batch.work.picture_work import PictureWork

__all__ = ["BatchResult", "make_avatars"]


@dataclass(frozen=True)
class BatchResult:
    """What became of the pictures of a batch.

    Attributes
    ----------
    statuses : mapping
        How many pictures have each status of :func:`toongeo.batch.read_manifest`, earlier runs included.
    skipped : int
        Pictures that an earlier run had done.
    manifest, report : Path

    Examples
    --------
    >>> from pathlib import Path
    >>> from toongeo.batch import BatchResult
    >>> result = BatchResult({"done": 5, "refused": 2}, 0, Path("heads/manifest.jsonl"), Path("heads/report.html"))
    >>> result.failed
    2
    """

    statuses: dict[str, int]
    skipped: int
    manifest: Path
    report: Path

    @property
    def failed(self) -> int:
        """Pictures without an avatar."""
        return sum(self.statuses.values()) - self.statuses.get("done", 0)


def make_avatars(
    folder: str | os.PathLike[str],
    output: str | os.PathLike[str],
    *,
    options: BatchOptions | None = None,
    limits: BatchLimits | None = None,
    backend: Backend = "loky",
    workers: int | None = None,
    scheduler: str | None = None,
    resume: bool = False,
    progress: bool = False,
) -> BatchResult:
    """Make an avatar of each picture of a folder, and list what came of it.

    A picture that fails, takes too long or too much, or costs its worker never stops the others, and leaves no part of
    a file. Files are the same to the byte whatever the backend and however many the workers. A picture that was being
    worked on when its worker was killed is tried once more. After an interruption ``resume`` goes on.

    Parameters
    ----------
    folder
        Of pictures, also in folders beneath it. Landmarks lie beside a picture under its name (``face.png`` and
        ``face.pts``); where there are none, they are found.
    output
        Folder of the avatars, of ``manifest.jsonl``, ``report.html`` and ``thumbnails``. It may lie in ``folder``.
    options : BatchOptions, optional
        What the avatars have in common.
    limits : BatchLimits, optional
        What a picture may take: 300 s and 3 GB. Memory is bounded where there are processes, time also with
        ``backend="serial"``: a thread cannot be ended.
    backend : {"loky", "threading", "serial", "dask", "ray"}
        Processes of joblib's loky, threads, none of either, or a cluster, whose computers see the same folders.
    workers : int, optional
        How many pictures at once; None: as many as there are cores.
    scheduler : str, optional
        Of a cluster that runs: ``tcp://...`` of dask, an address of ray. None: one on this computer is begun.
    resume : bool
        Leave out pictures that are done, or were refused, by the same options and version, and have not changed since.
    progress : bool
        Show a bar with the time that is left and the failures so far.

    Returns
    -------
    BatchResult

    Raises
    ------
    ValueError
        If there are no pictures, an argument is unknown, or the output holds a batch and ``resume`` is False.
    OSError
        If a folder cannot be read or written.
    ImportError
        If the backend is not installed.
    KeyboardInterrupt
        On Ctrl-C or SIGTERM, after all workers are ended and all parts of files removed.

    Examples
    --------
    ``toongeo.batch.make_avatars("portraits", "heads", progress=True)``, and of nothing:

    >>> import tempfile
    >>> make_avatars(tempfile.mkdtemp(), "heads")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    ValueError: folder: expected pictures (...), but there are none in ...
    """
    check_backend(backend, workers, scheduler)
    options, limits = options or BatchOptions(), _checked_limits(limits, backend)
    folder, output = Path(folder).absolute(), Path(output).absolute()
    jobs = picture_jobs(folder, output, options.suffix)
    manifest = output / MANIFEST
    if manifest.exists() and not resume:
        raise ValueError(f"output: expected a folder without a batch, but {output} holds one; resume=True goes on")
    before = read_manifest(manifest) if manifest.exists() else {}
    wanted = [job for job in jobs if not is_finished(job, before.get(job.name), options)]
    run = BatchRun(manifest, before, len(jobs) - len(wanted), progress)
    # BLAS is pinned here too: without processes the work is done here, and sums must not depend on that.
    with interruptible(), threadpool_limits(limits=1):
        engine = begun_engine(backend if wanted else "serial", workers, scheduler)
        try:
            remove_leftovers(output, jobs)
            append_record(manifest, run_head(folder, options, backend))
            run.work(engine, PictureWork(options, limits, os.getpid()), wanted)
        finally:
            remove_leftovers(output, jobs, last=True)
            write_report(output, run.records.values())
    statuses = Counter(run.records[job.name]["status"] for job in jobs if job.name in run.records)
    return BatchResult(dict(statuses), run.skipped, manifest, output / REPORT)


def _checked_limits(limits: BatchLimits | None, backend: Backend) -> BatchLimits:
    usual = BatchLimits()
    here = {"serial": BatchLimits(usual.seconds, None), "threading": BatchLimits(None, None)}
    if limits is None:
        return here.get(backend, usual)
    if backend in here and limits.memory_mb is not None:
        raise ValueError(f"limits: expected no memory_mb with backend {backend!r}, which has no worker to end")
    if backend == "threading" and limits.seconds is not None:
        raise ValueError("limits: expected no seconds with backend 'threading': a thread cannot be ended")
    return limits
