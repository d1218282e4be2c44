"""Backends on this computer: none, threads, and processes of loky, which comes with joblib."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from toongeo._extras import missing_extra

__all__ = ["LokyEngine", "SerialEngine", "ThreadEngine"]

_PINNED = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL", "VECLIB_MAXIMUM", "NUMEXPR")}


class SerialEngine:
    """One picture after the other, here."""

    workers = 1

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Done when it returns."""
        future: Future[Any] = Future()
        future.set_result(work(*arguments))
        return future

    def restart(self) -> None:
        """Nothing is lost here."""

    def close(self, *, now: bool) -> None:
        """There is nothing to end."""


class ThreadEngine:
    """Threads of this process: they share what it holds, and much of the work waits for one interpreter."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool = ThreadPoolExecutor(workers)

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin a call."""
        return self._pool.submit(work, *arguments)

    def restart(self) -> None:
        """Threads are not lost."""

    def close(self, *, now: bool) -> None:
        """A thread that is at work cannot be ended: wait for it."""
        self._pool.shutdown(wait=True, cancel_futures=now)


class LokyEngine:
    """Processes, each of which reads the template once; if one is killed all are begun anew.

    Raises
    ------
    ImportError
        If joblib is not installed.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool = self._begun()

    def _begun(self) -> Any:
        try:
            from joblib.externals.loky import ProcessPoolExecutor
        except ImportError as error:
            raise ImportError(missing_extra("a pool of processes", "batch")) from error
        return ProcessPoolExecutor(self.workers, timeout=None, env=_PINNED)

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin a call."""
        future: Future[Any] = self._pool.submit(work, *arguments)
        return future

    def restart(self) -> None:
        """All of them anew."""
        self._pool.shutdown(wait=True, kill_workers=True)
        self._pool = self._begun()

    def close(self, *, now: bool) -> None:
        """End them."""
        self._pool.shutdown(wait=True, kill_workers=now)
