"""Frames that are drawn on several cores, in their order."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor

import cv2
import numpy as np

__all__ = ["film_frames"]

_FEW = 48  # frames that are drawn before other processes have started
_AHEAD = 4  # frames a process that wait for the encoder
_worker: list[Callable[[int], np.ndarray]] = []  # of a process that draws: what it draws with


def film_frames(draw: Callable[[int], np.ndarray], count: int, *, processes: int | None = None) -> Iterator[np.ndarray]:
    """``draw(0)``, ``draw(1)``, ... ``draw(count - 1)``: the same pictures on any number of cores.

    This process draws too, whenever the frame that is next has not come from another; alone until those have started.

    Parameters
    ----------
    draw : callable of the number of a frame
        Can be pickled, and keeps nothing from one frame to the next.
    count : int
    processes : int, optional
        That draw, with this one. As many as there are cores, unless the film is so short that one is sooner done.
    """
    if processes is None:
        processes = 1 if count < _FEW else _cores()
    if processes <= 1:
        yield from map(draw, range(count))
        return
    context, threads = multiprocessing.get_context("spawn"), cv2.getNumThreads()
    cv2.setNumThreads(1)  # or those of OpenCV here would take the cores from the others
    with ProcessPoolExecutor(processes - 1, mp_context=context, initializer=_begin, initargs=(draw,)) as pool:
        started, number, ahead = pool.submit(os.getpid), 0, _AHEAD * processes
        waiting: deque[Future[np.ndarray]] = deque()
        try:
            while number < count and not started.done():
                yield draw(number)
                number += 1
            waiting.extend(pool.submit(_drawn, k) for k in range(number, min(number + ahead, count)))
            while waiting:
                while not waiting[0].done() and _drawn_here(waiting, number, draw):
                    pass
                yield waiting.popleft().result()
                number += 1
                if number + len(waiting) < count:
                    waiting.append(pool.submit(_drawn, number + len(waiting)))
        finally:
            cv2.setNumThreads(threads)
            for future in waiting:
                future.cancel()


def _drawn_here(waiting: deque[Future[np.ndarray]], number: int, draw: Callable[[int], np.ndarray]) -> bool:
    """Draw the first frame that no process has begun, if there is one; ``waiting`` begins with the frame ``number``."""
    for place, future in enumerate(waiting):
        if future.cancel():
            waiting[place] = Future()
            waiting[place].set_result(draw(number + place))
            return True
    return False


def _cores() -> int:
    """Those that this process may use, where the system tells."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _begin(draw: Callable[[int], np.ndarray]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that encodes is told, and ends the others
    cv2.setNumThreads(1)
    _worker[:] = [draw]


def _drawn(number: int) -> np.ndarray:
    return _worker[0](number)
