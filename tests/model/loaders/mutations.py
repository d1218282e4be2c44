"""Files that were damaged at random."""

import struct

import numpy as np

_WORDS = (0, 1, -1, 2**31 - 1, -(2**31), 255, 65536, 2**24)


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    """A file with bytes flipped, numbers replaced, pieces cut out, repeated or lost at the end."""
    data = bytearray(content)
    for _ in range(int(rng.integers(1, 5))):
        kind, at = int(rng.integers(7)), _place(len(data), rng)
        if kind == 0:
            data[at] ^= 1 << int(rng.integers(8))
        elif kind == 1:
            data[at] = int(rng.integers(256))
        elif kind == 2:
            word = struct.pack("<i", int(rng.choice(_WORDS)))
            data[at : at + 4] = word[: len(data) - at]
        elif kind == 3:
            del data[at : at + int(rng.integers(1, 64))]
        elif kind == 4:
            piece = data[at : at + int(rng.integers(1, 64))]
            data[at:at] = piece
        elif kind == 5:
            data[at : at + 8] = struct.pack("<d", float(rng.choice([np.nan, np.inf, 1e300, -1e9])))[: len(data) - at]
        else:
            data = data[: max(at, 1)]
        if not data:
            return b""
    return bytes(data)


def _place(size: int, rng: np.random.Generator) -> int:
    """Somewhere; half of the time near the start or end, where headers and directories are."""
    where = int(rng.integers(4))
    if where == 0:
        return int(rng.integers(min(size, 400)))
    if where == 1:
        return int(size - 1 - rng.integers(min(size, 1500)))
    return int(rng.integers(size))
