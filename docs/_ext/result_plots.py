"""Plots of the tables of ``benchmarks/RESULTS.md``."""

__all__ = ["setup"]


def setup(app):
    return {"parallel_read_safe": True, "parallel_write_safe": True}
