"""Bounds of time and memory."""

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

from toongeo.batch.batch_options import BatchLimits
from toongeo.batch.work.attempts import Attempts
from toongeo.batch.work.limited import OverTime, limited


def _passing_over_failures():
    while True:
        with contextlib.suppress(Exception):
            time.sleep(0.01)


def test_a_block_that_takes_too_long_is_interrupted_and_others_are_not():
    handler = signal.getsignal(signal.SIGALRM)
    with pytest.raises(OverTime, match="it took more than 0.05 s"), limited(BatchLimits(0.05, None)):
        _passing_over_failures()
    with limited(BatchLimits(0.2, None)):
        pass
    time.sleep(0.3)
    assert signal.getsignal(signal.SIGALRM) is handler


def _stuck(path):
    def work():
        with limited(BatchLimits(0.1, None), Attempts(path).say):
            time.sleep(60)

    thread = threading.Thread(target=work)  # no signal reaches it
    thread.start()
    thread.join()


def _greedy(path):
    kept = []
    with limited(BatchLimits(None, 100), Attempts(path).say):
        while True:
            kept.append(np.ones(10 << 20, np.uint8))
            time.sleep(0.02)


def _greedy_at_once(path):
    with limited(BatchLimits(None, 100), Attempts(path).say):
        try:
            np.ones(1 << 30, np.uint8)
        except MemoryError:
            os._exit(3)


@pytest.mark.parametrize(
    ("work", "reason", "status"),
    [(_stuck, "time", 75), (_greedy, "memory", 75), (_greedy_at_once, None, 3)],
)
def test_a_worker_that_takes_too_much_ends_itself_and_says_so(tmp_path, work, reason, status):
    if sys.platform != "linux" and work is not _stuck:
        pytest.skip("memory is bounded on Linux only")
    attempts = Attempts(tmp_path / "mark")
    attempts.begin()
    process = multiprocessing.get_context("spawn").Process(target=work, args=(tmp_path / "mark",))
    process.start()
    process.join(60)
    assert process.exitcode == status and attempts.last_words == reason and attempts.begun == 1
    assert attempts.is_hopeless == (reason is not None)
    attempts.end()
    attempts.end()
    assert attempts.begun == 0 and not attempts.is_hopeless


def test_enough_memory_is_enough():
    with limited(BatchLimits(None, 300), lambda reason: None):
        assert np.ones(100 << 20, np.uint8).sum() == 100 << 20


@pytest.mark.parametrize("bad", [0, -1, float("nan"), float("inf")])
def test_limits_are_positive(bad):
    with pytest.raises(ValueError, match="seconds: expected a number > 0 or None"):
        BatchLimits(seconds=bad)
    with pytest.raises(ValueError, match="memory_mb: expected a number > 0 or None"):
        BatchLimits(memory_mb=bad)
