"""BLAS on one thread."""

from contextlib import AbstractContextManager
from functools import cache

from threadpoolctl import ThreadpoolController

__all__ = ["one_thread"]


@cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()  # looking for the libraries takes longer than many a product


def one_thread() -> AbstractContextManager[object]:
    """Context in which BLAS uses one thread: for products of a few hundred rows more threads only wait
    for each other."""
    return _libraries().limit(limits=1, user_api="blas")
