"""One picture of a batch into its file and its record."""

from __future__ import annotations

import hashlib
import os
import threading
import time
import warnings
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from toongeo import __version__
from toongeo.avatar import Avatar, make_avatar
from toongeo.batch.batch_options import BatchLimits, BatchOptions
from toongeo.batch.picture_jobs import PictureJob, input_digest
from toongeo.batch.work.attempts import Attempts
from toongeo.batch.work.limited import OverTime, limited
from toongeo.io import atomic_write, encode_image, read_image, read_landmarks
from toongeo.pipeline import detect_landmarks

__all__ = ["PictureWork"]

_THUMBNAIL = 128  # px


@dataclass(frozen=True)
class PictureWork:
    """Makes avatars wherever it is sent; what fails is told in the record and never raised.

    Attributes
    ----------
    options : BatchOptions
    limits : BatchLimits
    home : int
        Number of the process that runs the batch, which must not end itself.
    """

    options: BatchOptions
    limits: BatchLimits
    home: int

    def __call__(self, job: PictureJob) -> dict[str, Any]:
        """The record of a picture."""
        attempts = Attempts(job.mark)
        record: dict[str, Any] = {
            "picture": job.name,
            "options": self.options.digest(),
            "version": __version__,
            "worker": os.getpid(),
        }
        if attempts.is_hopeless:
            record |= hopeless(attempts, self.limits)
            attempts.end()
            return record
        attempts.begin()
        started = time.perf_counter()
        is_worker = os.getpid() != self.home
        try:
            if is_worker:
                pinned()
            record["input"] = input_digest(job)
            with limited(self.limits, attempts.say if is_worker else None):
                record |= _made(job, self.options)
        except OverTime as error:
            record |= {"status": "over time", "error": str(error)}
        except MemoryError as error:
            record |= {"status": "over memory", "error": f"more than {self.limits.memory_mb} MB ({error})"[:500]}
        # Whatever a picture brings about, the others are to be made.
        except Exception as error:
            record |= {"status": "refused", "error": f"{type(error).__name__}: {error}"[:500]}
            if _is_memory(error):
                record["status"] = "over memory"
        record.setdefault("seconds", {})["total"] = round(time.perf_counter() - started, 3)
        record |= {"attempt": attempts.begun, "peak_mb": _peak_mb()}
        attempts.end()
        return record


def hopeless(attempts: Attempts, limits: BatchLimits) -> dict[str, Any]:
    """Status and error of a picture that has cost too many workers."""
    if (reason := attempts.last_words) is not None:
        most = f"{limits.seconds} s, and did not let go" if reason == "time" else f"{limits.memory_mb} MB"
        return {"status": f"over {reason}", "error": f"it took more than {most}"}
    return {"status": "killed", "error": f"{attempts.begun} workers were killed at it"}


@cache
def pinned() -> object:
    """One thread of BLAS for as long as a worker lives: how it splits sums would show in the last digits."""
    return threadpool_limits(limits=1)


def _made(job: PictureJob, options: BatchOptions) -> dict[str, Any]:
    """Save the avatar and its thumbnail, and tell about both."""
    with warnings.catch_warnings():
        if threading.current_thread() is threading.main_thread():
            warnings.simplefilter("ignore")  # of readers; they are for people who watch
        avatar, img = _avatar(job, options)
    for path in (job.output, job.thumbnail):
        path.parent.mkdir(parents=True, exist_ok=True)
    avatar.save(job.output, **options.saving)
    atomic_write({job.thumbnail: _thumbnail(img, avatar)})
    report = avatar.report
    seconds = {stage: round(value, 3) for stage, value in report.seconds.items()}
    return {
        "status": "done",
        "thumbnail": job.thumbnail.relative_to(job.mark.parent.parent).as_posix(),
        "error": None,
        "output_sha256": hashlib.sha256(job.output.read_bytes()).hexdigest(),
        "seconds": seconds,
        "metrics": {
            "coarse": {part: _rounded(value) for part, value in report.coarse.items()},
            "aligned": {part: _rounded(value) for part, value in report.aligned.items()},
            "intersecting": _rounded(report.quality.intersecting_fraction),
        },
        "warnings": list(report.warnings),
    }


def _avatar(job: PictureJob, options: BatchOptions) -> tuple[Avatar, np.ndarray]:
    img = read_image(job.picture)
    if job.landmarks is not None:
        landmarks = read_landmarks(job.landmarks, scheme=options.scheme, size=img)
    else:
        found = detect_landmarks(img)
        if not (found.is_sure or options.accept):
            raise ValueError(f"landmarks: those found are not sure (face {100 * found.score:.0f} %)")
        landmarks = found.points
    return make_avatar(img, landmarks, **options.making), img


def _thumbnail(img: np.ndarray, avatar: Avatar) -> bytes:
    """The picture and the head side by side."""
    import cv2

    height, width = img.shape[:2]
    scale = _THUMBNAIL / max(height, width)
    small = cv2.resize(img, (max(1, round(scale * width)), max(1, round(scale * height))), interpolation=cv2.INTER_AREA)
    both = np.full((_THUMBNAIL, 2 * _THUMBNAIL, 3), 255, np.uint8)
    both[: small.shape[0], : small.shape[1]] = small
    both[:, _THUMBNAIL:] = avatar.render(size=_THUMBNAIL)
    return encode_image(both, ".jpg", quality=85)


def _rounded(value: float) -> float | None:
    return round(float(value), 6) if np.isfinite(value) else None


def _is_memory(error: BaseException | None) -> bool:
    """Whether it comes of memory that was not given; OpenCV and readers say it in other words."""
    while error is not None:
        if isinstance(error, MemoryError) or "Insufficient memory" in str(error) or "bad allocation" in str(error):
            return True
        error = error.__cause__
    return False


def _peak_mb() -> int | None:
    """Of this process, since it began."""
    try:
        import resource
    except ImportError:
        return None
    return int(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) >> 10
