"""A block of bounded time and memory."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from types import FrameType

from toongeo.batch.batch_options import BatchLimits

__all__ = ["OverTime", "limited"]

_GRACE = 10.0  # s that a compiled routine may take to come back once time is up
_BLINK = 0.05  # s between two looks at the memory, in which some 100 MB are filled
_ENDED = 75  # exit status of a worker that ended itself


class OverTime(BaseException):
    """Time is up. No ``Exception``, so that nothing on the way takes it for a failure that it knows."""


@contextmanager
def limited(limits: BatchLimits, last_words: Callable[[str], None] | None = None) -> Iterator[None]:
    """Raise :class:`OverTime`, or end this process, where a block takes too much.

    In the main thread of a process a signal interrupts the block when time is up. Elsewhere, where a compiled routine
    does not come back, and where memory runs out, which no compiled routine takes well, the process ends itself after
    ``last_words("time")`` or ``("memory")``. Without last words, which only workers may have, it goes on.
    """
    with ExitStack() as stack:
        if limits.memory_mb is not None and last_words is not None and sys.platform == "linux":
            stack.enter_context(_address_space(2 * limits.memory_mb))
            stack.enter_context(_memory(limits.memory_mb, partial(_end, last_words, "memory")))
        if limits.seconds is not None:
            interrupts = threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer")
            if last_words is not None:
                late = limits.seconds + (_GRACE if interrupts else 0.0)
                stack.enter_context(_timer(late, partial(_end, last_words, "time")))
            if interrupts:
                stack.enter_context(_alarm(limits.seconds))
        yield


@contextmanager
def _alarm(seconds: float) -> Iterator[None]:
    def ring(number: int, frame: FrameType | None) -> None:
        raise OverTime(f"it took more than {seconds:g} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@contextmanager
def _timer(seconds: float, end: Callable[[], None]) -> Iterator[None]:
    timer = threading.Timer(seconds, end)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _end(last_words: Callable[[str], None], reason: str) -> None:
    last_words(reason)
    os._exit(_ENDED)


@contextmanager
def _memory(most_mb: int, end: Callable[[], None]) -> Iterator[None]:
    """Watch what this process holds."""
    most, over = _held(1) + (most_mb << 20), threading.Event()

    def watch() -> None:
        while not over.wait(_BLINK):
            if _held(1) > most:
                end()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()


def _held(column: int) -> int:
    """Bytes of this process: of its address space (0), or in memory (1)."""
    return int(Path("/proc/self/statm").read_text().split()[column]) * os.sysconf("SC_PAGE_SIZE")


@contextmanager
def _address_space(most_mb: int) -> Iterator[None]:
    """What is asked for at once beyond this is not given, however fast the watch is."""
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    wanted = _held(0) + (most_mb << 20)
    resource.setrlimit(resource.RLIMIT_AS, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
