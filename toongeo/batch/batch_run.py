"""One run of a batch: its engine, its manifest, its bar."""

from __future__ import annotations

import contextlib
import platform
import signal
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import FrameType
from typing import Any

from tqdm import tqdm

from toongeo import __version__
from toongeo.batch.batch_options import BatchOptions
from toongeo.batch.engines.engine import Engine
from toongeo.batch.manifest import Record, append_record
from toongeo.batch.picture_jobs import PictureJob
from toongeo.batch.streamed_records import streamed_records
from toongeo.batch.work.picture_work import PictureWork

__all__ = ["BatchRun", "interruptible", "run_head"]

_PACKAGES = ("numpy", "scipy", "libigl", "scikit-image", "opencv-contrib-python-headless", "pillow", "nlopt")


@dataclass
class BatchRun:
    """Where records go.

    Attributes
    ----------
    manifest : Path
    records : dict
        The latest of each picture, those of earlier runs included.
    skipped : int
        Pictures that need not be done.
    progress : bool
    """

    manifest: Path
    records: dict[str, Record]
    skipped: int
    progress: bool
    failed: int = field(default=0, init=False)

    def work(self, engine: Engine, work: PictureWork, jobs: Sequence[PictureJob]) -> None:
        """Write records as they come; end the engine whatever happens."""
        is_done = False
        total = len(jobs) + self.skipped
        # A first guess of the time left is no better than its first picture: smoothed over some twenty.
        with tqdm(total=total, initial=self.skipped, unit="picture", disable=not self.progress, smoothing=0.05) as bar:
            try:
                for record in streamed_records(engine, work, jobs):
                    self._add(record)
                    bar.set_postfix(failed=self.failed, refresh=False)
                    bar.update()
                is_done = True
            finally:
                engine.close(now=not is_done)

    def _add(self, record: Record) -> None:
        append_record(self.manifest, record)
        self.records[record["picture"]] = record
        self.failed += record["status"] != "done"


def run_head(folder: Path, options: BatchOptions, backend: str) -> dict[str, Any]:
    """The line of a run in the manifest: what all its pictures have in common."""
    packages = {"python": platform.python_version(), "toongeo": __version__}
    for name in _PACKAGES:
        with contextlib.suppress(PackageNotFoundError):
            packages[name] = version(name)
    return {
        "batch": str(folder),
        "digest": options.digest(),
        "options": options.plain(),
        "backend": backend,
        "versions": packages,
    }


@contextmanager
def interruptible() -> Iterator[None]:
    """SIGTERM as Ctrl-C, so that it ends as cleanly."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
