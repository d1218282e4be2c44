"""The backend of a name."""

from __future__ import annotations

import os
from typing import Literal

from toongeo.batch.engines.dask_engine import DaskEngine
from toongeo.batch.engines.engine import Engine
from toongeo.batch.engines.local_engines import LokyEngine, SerialEngine, ThreadEngine
from toongeo.batch.engines.ray_engine import RayEngine

__all__ = ["BACKENDS", "Backend", "begun_engine", "check_backend"]

Backend = Literal["loky", "threading", "serial", "dask", "ray"]
BACKENDS: tuple[Backend, ...] = ("loky", "threading", "serial", "dask", "ray")


def check_backend(backend: str, workers: int | None, scheduler: str | None) -> None:
    """Refuse an unknown backend, a number of workers that is none, and a scheduler of a backend without.

    Raises
    ------
    ValueError
        Names the argument.
    """
    if backend not in BACKENDS:
        raise ValueError(f"backend: expected one of {', '.join(BACKENDS)}, got {backend!r}")
    if scheduler is not None and backend not in ("dask", "ray"):
        raise ValueError(f"scheduler: expected backend 'dask' or 'ray' with it, got {backend!r}")
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise ValueError(f"workers: expected an integer > 0, got {workers!r}")


def begun_engine(backend: Backend, workers: int | None, scheduler: str | None) -> Engine:
    """Workers that wait for work.

    Raises
    ------
    ImportError
        If the backend is not installed.
    OSError
        If no scheduler answers.
    """
    count = workers or os.cpu_count() or 1
    if backend == "dask":
        return DaskEngine(count, scheduler)
    if backend == "ray":
        return RayEngine(count, scheduler)
    if backend == "serial":
        return SerialEngine()
    return ThreadEngine(count) if backend == "threading" else LokyEngine(count)
