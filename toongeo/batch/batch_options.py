"""How a batch makes its avatars, and what a picture may take."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from toongeo.avatar.save_avatar import writer_for

__all__ = ["BatchLimits", "BatchOptions"]


@dataclass(frozen=True)
class BatchOptions:
    """What all avatars of a batch have in common.

    Attributes
    ----------
    suffix : str
        Of the files: ``.glb``, ``.vrm``, ``.html``, ``.usdz``, ``.obj`` or ``.ply``.
    making : mapping
        Options of :func:`toongeo.make_avatar`, such as ``{"texture_size": 512}``: numbers, texts and truth values.
    saving : mapping
        Options of :meth:`toongeo.Avatar.save`, such as ``{"quantize": True}``.
    scheme : str
        Of files of landmarks: see :func:`toongeo.read_landmark_file`.
    accept : bool
        Go on with landmarks that were found but are not sure; without, such a picture fails.

    Raises
    ------
    ValueError
        If a file of this suffix has no such option, or an option is no plain value.

    Examples
    --------
    >>> BatchOptions(making={"texture_size": 512}).digest() == BatchOptions().digest()
    False
    """

    suffix: str = ".glb"
    making: Mapping[str, Any] = field(default_factory=dict)
    saving: Mapping[str, Any] = field(default_factory=dict)
    scheme: str = "auto"
    accept: bool = False

    def __post_init__(self) -> None:
        from pathlib import Path

        writer_for(Path(f"a{self.suffix}"), None, dict(self.saving))
        for name, value in {**self.making, **self.saving}.items():
            if not (value is None or isinstance(value, bool | int | float | str)):
                raise ValueError(f"{name}: expected a number, a text or a truth value, got {type(value).__name__}")

    def plain(self) -> dict[str, Any]:
        """As JSON takes it."""
        return asdict(self) | {"making": dict(self.making), "saving": dict(self.saving)}

    def digest(self) -> str:
        """SHA-256 of all of them: equal options give equal files."""
        return hashlib.sha256(json.dumps(self.plain(), sort_keys=True).encode()).hexdigest()


@dataclass(frozen=True)
class BatchLimits:
    """What one picture may take; None: as much as it likes.

    Attributes
    ----------
    seconds : float, optional
        Of the clock. A picture of 1024 px takes some ten.
    memory_mb : int, optional
        That a worker may grow by while it is at it; on Linux only. A picture of 1024 px takes some 500.

    Raises
    ------
    ValueError
        If one is not positive.

    Examples
    --------
    >>> from toongeo.batch import BatchLimits
    >>> BatchLimits(seconds=60.0).seconds
    60.0
    """

    seconds: float | None = 300.0
    memory_mb: int | None = 3000

    def __post_init__(self) -> None:
        for name in ("seconds", "memory_mb"):
            value = getattr(self, name)
            if value is not None and not 0 < value < float("inf"):
                raise ValueError(f"{name}: expected a number > 0 or None, got {value!r}")
