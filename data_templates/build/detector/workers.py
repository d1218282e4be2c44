"""The same work in one process or in several."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from multiprocessing import get_context
from typing import Any

import cv2

__all__ = ["mapped"]


def mapped(function: Callable[[Any], Any], jobs: Iterable[Any], processes: int, together: int = 1) -> list[Any]:
    """``function(job)`` of every job in order, so many `together`.

    Processes are forked: they find in the globals of their module what is too large to be sent.
    """
    if processes == 1:
        return [function(job) for job in jobs]
    cv2.setNumThreads(1)  # threads of OpenCV do not survive a fork
    with get_context("fork").Pool(processes) as pool:
        return pool.map(function, jobs, chunksize=together)
