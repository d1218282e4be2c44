"""Weights to a page that ``toongeo serve`` shows."""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from toongeo.driving.websockets_adapter import load_websockets

__all__ = ["send_weights"]


def send_weights(
    url: str,
    frames: Iterable[Mapping[str, float] | Sequence[float] | np.ndarray],
    *,
    fps: float | None = None,
    timeout: float = 10.0,
) -> int:
    """Send weights, frame by frame, and wait until a page has applied them all.

    Parameters
    ----------
    url : str
        What ``toongeo serve`` prints for sources, ``ws://127.0.0.1:PORT/source?token=...``.
    frames : weights by name, or arrays of 54 in the order of the avatar's targets
    fps : float, optional
        How fast; None: as fast as they go.
    timeout : float
        Seconds to wait for the page.

    Returns
    -------
    int
        How many were applied.

    Raises
    ------
    ImportError
        If ``websockets`` is not installed.
    ValueError
        If the address is none, the server refuses the token or is none of ours, or does not understand a frame.
    OSError
        If there is no server, it goes away, or no page answers in time.

    Examples
    --------
    >>> import toongeo as tg
    >>> words = [{"jawOpen": k / 10} for k in range(10)]
    >>> tg.send_weights("ws://127.0.0.1:8000/source?token=...", words, fps=30)  # doctest: +SKIP
    >>> tg.send_weights("127.0.0.1", words)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    ValueError: url: expected ws://...
    """
    if fps is not None and not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
    websockets = load_websockets()
    sent, applied = 0, 0
    try:
        with websockets.connect(url, compression=None, proxy=None) as socket:
            started = time.monotonic()
            for frame in frames:
                socket.send(json.dumps(dict(frame) if isinstance(frame, Mapping) else np.asarray(frame).tolist()))
                sent += 1
                if fps:
                    time.sleep(max(0.0, started + sent / fps - time.monotonic()))
            while applied < sent:
                applied += _applied(socket.recv(timeout=timeout))
    except websockets.InvalidURI as error:
        raise ValueError(f"url: expected ws://127.0.0.1:PORT/source?token=..., got {url!r} ({error})") from None
    except websockets.InvalidStatus as error:
        raise ValueError(f"url: the server refuses it ({error})") from None
    except websockets.InvalidHandshake as error:
        raise ValueError(f"url: expected the server of toongeo serve, {url} is none ({error})") from None
    except websockets.ConnectionClosed as error:
        raise ConnectionError(f"the server closed the connection ({error})") from None
    except TimeoutError:
        raise TimeoutError(f"no page has applied more than {applied} of {sent} frames in {timeout} s") from None
    return applied


def _applied(answer: str) -> int:
    try:
        content = json.loads(answer)
        if "error" in content:
            raise ValueError(f"frames: {content['error']}")
        return int(content["applied"])
    except (LookupError, TypeError, json.JSONDecodeError, RecursionError, OverflowError) as error:
        raise ValueError(f"url: expected the server of toongeo serve, its answer is none ({error!r})"[:300]) from None
