"""Backend of many computers: ray, where it is installed."""

from __future__ import annotations

from concurrent.futures import Future
from typing import Any

__all__ = ["RayEngine"]


class RayEngine:
    """Workers of ray. All of them must see the same folders under the same names.

    Parameters
    ----------
    workers : int
        Pictures at once.
    address : str, optional
        Of a cluster that runs; None begins one here.

    Raises
    ------
    ImportError
        If ray is not installed.
    """

    def __init__(self, workers: int, address: str | None = None) -> None:
        try:
            import ray
        except ImportError as error:
            raise ImportError("the backend ray needs ray: pip install ray") from error
        self.workers, self._ray = workers, ray
        ray.init(address=address, num_cpus=workers if address is None else None, log_to_driver=False)

    def submit(self, work: Any, *arguments: Any) -> Future[Any]:
        """Begin a call."""
        # A picture that costs a worker is tried again by the batch itself.
        remote: Any = self._ray.remote(max_retries=0)
        begun = remote(work if hasattr(work, "__name__") else work.__call__)
        future: Future[Any] = begun.remote(*arguments).future()
        return future

    def restart(self) -> None:
        """Ray puts new workers in the place of lost ones."""

    def close(self, *, now: bool) -> None:
        """End what was begun here."""
        self._ray.shutdown()
