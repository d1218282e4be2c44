"""A network in ONNX's protobuf, written by hand: two inputs, each flattened and multiplied by a matrix."""


def _varint(n):
    out = b""
    while n > 127:
        out, n = out + bytes([n & 127 | 128]), n >> 7
    return out + bytes([n])


def _field(number, value):
    if isinstance(value, int):
        return _varint(number << 3) + _varint(value)
    value = value.encode() if isinstance(value, str) else value
    return _varint(number << 3 | 2) + _varint(len(value)) + value


def _tensor(name, array):
    dims = b"".join(_field(1, n) for n in array.shape)
    return dims + _field(2, 1) + _field(8, name) + _field(9, array.astype("<f4").tobytes())


def _value(name, shape):
    dims = b"".join(_field(1, _field(1, n)) for n in shape)
    return _field(1, name) + _field(2, _field(1, _field(1, 1) + _field(2, dims)))


def _node(kind, inputs, output):
    return b"".join(_field(1, name) for name in inputs) + _field(2, output) + _field(4, kind)


def tiny_onnx(matrices):
    """Bytes of a network: ``matrices`` maps an output to (input, its shape, matrix)."""
    graph = b""
    for name, (source, _, _) in matrices.items():
        graph += _field(1, _node("Flatten", [source], f"{name}_flat"))
        graph += _field(1, _node("MatMul", [f"{name}_flat", f"{name}_weights"], name))
    graph += _field(2, "tiny")
    for name, (_, _, matrix) in matrices.items():
        graph += _field(5, _tensor(f"{name}_weights", matrix))
    for source, shape, _ in matrices.values():
        graph += _field(11, _value(source, shape))
    for name, (_, _, matrix) in matrices.items():
        graph += _field(12, _value(name, (1, matrix.shape[1])))
    return _field(1, 8) + _field(7, graph) + _field(8, _field(1, "") + _field(2, 13))
