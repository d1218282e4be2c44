"""Backend of many computers: dask."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from toongeo._extras import missing_extra

__all__ = ["DaskEngine"]


class DaskEngine:
    """Workers of a dask scheduler, or of a cluster that is begun here and ended with the batch.

    All of them must see the same folders under the same names.

    Parameters
    ----------
    workers : int
        Of a cluster of one's own.
    scheduler : str, optional
        Address of one that runs, ``tcp://...``.

    Raises
    ------
    ImportError
        If dask is not installed.
    OSError
        If no scheduler answers there.
    """

    def __init__(self, workers: int, scheduler: str | None = None) -> None:
        dask, distributed = _modules()
        # A picture that costs a worker is tried again by the batch itself.
        dask.config.set({"distributed.scheduler.allowed-failures": 0})
        self._cluster: Any = None
        if scheduler is None:
            self._cluster = distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address=None,
                memory_limit=0,
                silence_logs=logging.CRITICAL,
            )
        try:
            self._client = distributed.Client(self._cluster or scheduler, timeout=30, set_as_default=False)
        except (OSError, ValueError) as error:
            raise ConnectionError(f"scheduler: expected one at {scheduler}, but none answers ({error})") from error
        self.workers = max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))
        self._pool = self._client.get_executor(pure=False)

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Begin a call."""
        future: Future[Any] = self._pool.submit(work, *arguments)
        return future

    def restart(self) -> None:
        """Nannies put new workers in the place of lost ones."""

    def close(self, *, now: bool) -> None:
        """Workers of others stay."""
        with contextlib.suppress(Exception):  # a scheduler that is gone has no farewell
            self._client.close(timeout=5)
        if self._cluster is not None:
            self._cluster.close(timeout=20)


def _modules() -> tuple[Any, Any]:
    try:
        import dask
        import distributed
    except ImportError as error:
        raise ImportError(missing_extra("a cluster", "cluster")) from error
    return dask, distributed
