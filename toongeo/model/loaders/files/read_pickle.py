"""Plain arrays out of a pickle, of which nothing is executed.

The one file of this library that opens pickles: FLAME and its tables exist as nothing else.
"""

from __future__ import annotations

import io
import math
import pickle
import pickletools
import re
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["plain", "unpickled"]

_MOST_STEPS = 20_000  # of a pickle; those of FLAME have some hundred. Objects nest no deeper than that
# What a pickle may do: make numbers, text and containers, and name classes, which are looked up in _KINDS.
_TEXT = "STRING BINSTRING SHORT_BINSTRING UNICODE BINUNICODE SHORT_BINUNICODE BINUNICODE8"
_BYTES = "BINBYTES SHORT_BINBYTES BINBYTES8 BYTEARRAY8"
_SINGLE = "NONE NEWTRUE NEWFALSE INT BININT BININT1 BININT2 LONG LONG1 LONG4 FLOAT BINFLOAT"
_CONTAINERS = (
    "EMPTY_LIST APPEND APPENDS LIST EMPTY_TUPLE TUPLE TUPLE1 TUPLE2 TUPLE3 EMPTY_DICT DICT SETITEM SETITEMS MARK"
)
_MACHINE = "PROTO FRAME STOP POP POP_MARK DUP GET BINGET LONG_BINGET PUT BINPUT LONG_BINPUT MEMOIZE"
_OBJECTS = "GLOBAL STACK_GLOBAL REDUCE BUILD NEWOBJ"
_STEPS = frozenset(" ".join((_TEXT, _BYTES, _SINGLE, _CONTAINERS, _MACHINE, _OBJECTS)).split())
_MEMO = frozenset(("PUT", "BINPUT", "LONG_BINPUT"))
_KINDS: tuple[tuple[str, str], ...] = (  # module.name -> what a stand-in of it is read as
    (r"numpy\.(core|_core)\.multiarray\._reconstruct", "array"),
    (r"numpy\.(core|_core)\.numeric\._frombuffer", "buffer"),
    (r"numpy\.(core|_core)\.multiarray\.scalar", "scalar"),
    (r"numpy\.dtype", "dtype"),
    (r"numpy\.ndarray|(__builtin__|builtins)\.object", "class"),
    (r"scipy\.sparse\.(\w+\.)?cs[cr]_(matrix|array)", "sparse"),
    (r"chumpy\.[\w.]+", "chumpy"),
    (r"copy_?reg\._reconstructor", "made"),
    (r"_codecs\.encode", "encode"),
    (r"collections\.OrderedDict", "dict"),
)
_NUMBER = re.compile(r"[<>|=]?[biuf][1248]")


class _StandIn:
    """In place of an object: what it would have been made from."""

    kind, origin = "", ""
    given: tuple[Any, ...] = ()  # an object that is made without a call has none of its own
    state: Any = None

    def __init__(self, *given: Any) -> None:
        self.given = given

    def __setstate__(self, state: Any) -> None:
        self.state = state

    def __setitem__(self, key: Any, value: Any) -> None:
        self.state = {**(self.state or {}), key: value}


class _Reader(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        for pattern, kind in _KINDS:
            if re.fullmatch(pattern, f"{module}.{name}"):
                # A class of its own each time: a pickle that writes to it reaches nothing else.
                return type("StandIn", (_StandIn,), {"kind": kind, "origin": f"{module}.{name}"})
        raise ValueError(f"a pickle of numbers names no {module}.{name}, which is refused; nothing was executed")


def unpickled(content: bytes) -> Any:
    """What a pickle holds, with stand-ins for its objects, to be read by :func:`plain`.

    Its steps are checked first against those that numbers and containers need. Every class and function that it names
    is replaced by an inert stand-in if it is one of numpy, scipy.sparse or chumpy, and refused otherwise.

    Raises
    ------
    ValueError
        If it names anything else, takes a step that numbers do not need, or more than 20,000 of them.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the parser, about damaged text
        _check_steps(content)
        return _Reader(io.BytesIO(content), encoding="latin1").load()


def _check_steps(content: bytes) -> None:
    """Refuse what numbers do not need, before anything is built."""
    for count, (step, argument, _) in enumerate(pickletools.genops(content)):
        if step.name not in _STEPS:
            raise ValueError(f"a pickle of numbers has no step {step.name}")
        if count > _MOST_STEPS or (step.name in _MEMO and int(argument or 0) > _MOST_STEPS):
            raise ValueError(f"a pickle of numbers has no more than {_MOST_STEPS} steps")
        if step.name == "GLOBAL":
            _Reader(io.BytesIO(b"")).find_class(*str(argument).split(" ", 1))  # refused before anything is built


def plain(value: Any, seen: dict[int, Any] | None = None) -> Any:
    """Arrays, numbers, text and containers of them in place of stand-ins; None for what is nothing of these.

    Raises
    ------
    ValueError
        If an array is not of the size that it says, or holds objects.
    """
    seen = {} if seen is None else seen
    if id(value) in seen:
        return seen[id(value)]
    if isinstance(value, dict):
        found: Any = {key: plain(part, seen) for key, part in value.items() if isinstance(key, str)}
    elif isinstance(value, list | tuple):
        found = [plain(part, seen) for part in value]
    elif isinstance(value, _StandIn):
        found = _READERS.get(value.kind, lambda stand_in, seen: None)(value, seen)
    else:
        found = value if isinstance(value, bool | int | float | str | bytes | bytearray | None) else None
    seen[id(value)] = found
    return found


def _array(stand_in: _StandIn, seen: dict[int, Any]) -> NDArray | list[Any]:
    state = stand_in.state
    if not isinstance(state, tuple) or len(state) not in (4, 5):
        raise ValueError("an array in the pickle has no content")
    shape, dtype, fortran, raw = state[-4:]
    if isinstance(raw, list):  # an array of objects is a list of them
        return [plain(part, seen) for part in raw]
    return _numbers(plain(raw, seen), dtype, shape, bool(fortran))


def _buffer(stand_in: _StandIn, seen: dict[int, Any]) -> NDArray:
    raw, dtype, shape, order = stand_in.given
    return _numbers(raw, dtype, shape, order == "F")


def _scalar(stand_in: _StandIn, seen: dict[int, Any]) -> NDArray:
    dtype, raw = stand_in.given
    return _numbers(plain(raw, seen), dtype, (), False)


def _numbers(raw: Any, dtype: Any, shape: Any, fortran: bool) -> NDArray:
    raw = raw.encode("latin1") if isinstance(raw, str) else raw
    if not isinstance(raw, bytes | bytearray) or not isinstance(shape, tuple):
        raise ValueError("an array in the pickle holds objects, not numbers")
    if not all(isinstance(n, int) and n >= 0 for n in shape):
        raise ValueError(f"an array in the pickle has the shape {shape}")
    kind = _dtype(dtype)
    if math.prod(shape) * kind.itemsize != len(raw):
        raise ValueError(f"an array of shape {shape} of {kind} in the pickle has {len(raw)} bytes")
    return np.frombuffer(raw, kind).reshape(shape, order="F" if fortran else "C")


def _dtype(stand_in: Any) -> np.dtype:
    name = stand_in.given[0] if isinstance(stand_in, _StandIn) and stand_in.given else None
    if not isinstance(name, str) or not _NUMBER.fullmatch(name):
        raise ValueError(f"an array in the pickle holds {name!r}, not numbers")
    state = stand_in.state
    swapped = isinstance(state, tuple) and len(state) > 1 and state[1] == ">"
    return np.dtype(name).newbyteorder(">" if swapped else "<")


def _sparse(stand_in: _StandIn, seen: dict[int, Any]) -> NDArray:
    """Dense array (r, c) of a compressed sparse one."""
    state = plain(stand_in.state, seen)
    if not isinstance(state, dict):
        raise ValueError("a sparse matrix in the pickle has no content")
    rows, columns = (int(n) for n in state.get("_shape") or state["shape"])
    data, indices, starts = (np.asarray(state[name]).ravel() for name in ("data", "indices", "indptr"))
    by_column = "csc" in stand_in.origin
    outer, inner = (columns, rows) if by_column else (rows, columns)
    if min(rows, columns) < 0 or rows * columns > 10 * 10**6:  # FLAME's is 5 x 5023
        raise ValueError(f"a sparse matrix in the pickle is {rows} x {columns}")
    if len(starts) != outer + 1 or starts[0] != 0 or (np.diff(starts) < 0).any() or starts[-1] != len(data):
        raise ValueError("a sparse matrix in the pickle does not fit together")
    if len(indices) != len(data) or (len(indices) and not 0 <= indices.min() <= indices.max() < inner):
        raise ValueError("a sparse matrix in the pickle has indices out of range")
    dense = np.zeros((outer, inner))
    np.add.at(dense, (np.repeat(np.arange(outer), np.diff(starts)), indices), data)
    return dense.T if by_column else dense


def _chumpy(stand_in: _StandIn, seen: dict[int, Any]) -> Any:
    """The numbers that a variable of chumpy holds; None if it is a formula of others."""
    state = plain(stand_in.state, seen)
    return state.get("x") if isinstance(state, dict) else None


def _made(stand_in: _StandIn, seen: dict[int, Any]) -> Any:
    """An object that Python 2 wrote: its class is the first argument."""
    made = stand_in.given[0]() if stand_in.given and isinstance(stand_in.given[0], type) else None
    if not isinstance(made, _StandIn) or made.kind not in ("sparse", "chumpy"):
        return None
    made.state = stand_in.state
    return plain(made, seen)


def _encoded(stand_in: _StandIn, seen: dict[int, Any]) -> bytes | None:
    text = stand_in.given[0] if stand_in.given else None
    return text.encode("latin1") if isinstance(text, str) else None


def _ordered(stand_in: _StandIn, seen: dict[int, Any]) -> Any:
    return plain(stand_in.state or {}, seen)


_READERS = {
    "array": _array,
    "buffer": _buffer,
    "scalar": _scalar,
    "sparse": _sparse,
    "chumpy": _chumpy,
    "made": _made,
    "encode": _encoded,
    "dict": _ordered,
}
