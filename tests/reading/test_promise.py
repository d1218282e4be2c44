"""What readers promise about errors."""

import errno
import io
import json
import os
import struct
import warnings
import zipfile
import zlib

import numpy as np
import pytest

import toongeo
from toongeo.reading.check_file import check_file, file_bytes
from toongeo.reading.npy_array import npy_array
from toongeo.reading.promise import promise, promised
from toongeo.reading.read_npz import read_npz

SURPRISES = [
    zipfile.BadZipFile("File is not a zip file"),
    EOFError("no data left"),
    TypeError("'<' not supported"),
    KeyError("points"),
    IndexError("list index out of range"),
    AttributeError("'int' object has no attribute 'get'"),
    RecursionError("maximum recursion depth exceeded"),
    OverflowError("int too large to convert to float"),
    ZeroDivisionError("division by zero"),
    struct.error("unpack requires a buffer of 4 bytes"),
    zlib.error("Error -3"),
    UnicodeDecodeError("utf-8", b"\xff", 0, 1, "invalid start byte"),
    SyntaxError("not a PNG file"),
    NotImplementedError("compression type 9"),
    json.JSONDecodeError("Expecting value", "", 0),
    ValueError("cannot reshape array of size 3"),
    OSError("image file is truncated"),
]


@pytest.mark.parametrize("surprise", SURPRISES, ids=lambda error: type(error).__name__)
def test_surprises_become_value_errors_that_name_argument_and_cause(surprise):
    message = r"file: expected a tune, but a\.mid is damaged or none \("
    with pytest.raises(ValueError, match=message) as info, promise("a.mid", "a tune", argument="file"):
        raise surprise
    assert type(info.value) is ValueError and info.value.__cause__ is surprise
    assert type(surprise).__name__ in str(info.value) and str(surprise)[:20] in str(info.value)


def test_what_is_named_already_passes_unchanged():
    for message in ("face: expected 0..3, got 7", "uv_faces, uv: expected as many", "in a.mid there is no sound"):
        with pytest.raises(ValueError, match="expected|sound") as info, promise("a.mid", "a tune"):
            raise ValueError(message)
        assert str(info.value) == message and info.value.__cause__ is None


def test_a_file_that_alone_can_be_at_fault():
    """What names something else inside is about the file, too; what names the file or its argument passes."""
    message = r"^model: expected a face, but a\.npz is damaged or none \(ValueError: faces: expected"
    with pytest.raises(ValueError, match=message), promise("a.npz", "a face", "model", alone=True):
        raise ValueError("faces: expected vertices in 0..3, got 7")
    for named in ("model: expected another", "in a.npz there is no face"):
        with (
            pytest.raises(ValueError, match="another|no face") as info,
            promise("a.npz", "a face", "model", alone=True),
        ):
            raise ValueError(named)
        assert str(info.value) == named


def test_numbers_of_a_damaged_file_warn_of_nothing():
    with promise("a.mid", "a tune"):
        assert np.isnan(np.array([np.inf]) - np.inf).all()


def test_memory_imports_and_warnings():
    message = r"path: expected a tune that fits into memory, but a\.mid"
    with pytest.raises(ValueError, match=message), promise("a.mid", "a tune"):
        raise MemoryError
    for error in (ImportError("the extra `usd`"), KeyboardInterrupt(), UserWarning("slow")):
        with pytest.raises(type(error)) as info, promise("a.mid", "a tune"):
            raise error
        assert info.value is error


def test_errors_of_the_system_name_the_file():
    with pytest.raises(OSError, match=r"cannot read a\.mid: Input/output error") as info, promise("a.mid", "a tune"):
        raise OSError(errno.EIO, "Input/output error")
    assert info.value.errno == errno.EIO
    with pytest.raises(FileNotFoundError, match="nothing"), promise("nothing", "a tune"):
        open("nothing").close()


def test_readers_say_what_is_no_name_of_a_file():
    @promised("a tune", argument="file")
    def read_tune(file):
        raise AssertionError

    for wrong in (5, None, ["a.mid"], io.BytesIO()):
        with pytest.raises(ValueError, match=f"file: expected the name of a file, got {type(wrong).__name__}"):
            read_tune(wrong)
        with pytest.raises(ValueError, match="file: expected the name of a file"):
            read_tune(file=wrong)
    with pytest.raises(ValueError, match="file: expected the name of a file, got one with a zero byte"):
        read_tune("a\0b")


def test_large_files_are_refused_before_they_are_read(tmp_path):
    path = tmp_path / "sparse"
    with path.open("wb") as stream:
        stream.truncate(3 << 20)
    check_file(path, 3)
    with pytest.raises(ValueError, match=r"path: expected a file of at most 2 MB, but .*sparse is larger"):
        file_bytes(path, 2)


def npy_header(shape, descr="'<f8'", version=1):
    text = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    text += b" " * (-(len(text) + 11) % 64) + b"\n"
    return b"\x93NUMPY" + bytes([version, 0]) + struct.pack("<H", len(text)) + text


@pytest.mark.parametrize(
    "shape", ["(9999999999999, 2)", "(4611686018427387904, 4)", "(True, 2)", "(-1, 2)", "(68.0, 2)"]
)
def test_npy_headers_that_announce_too_much(shape):
    content = npy_header(shape) + bytes(1088)
    with pytest.raises(ValueError, match="the shape is|tuple of integers|not valid"):
        npy_array(io.BytesIO(content), len(content))


def archive(path, **entries):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in entries.items():
            file.writestr(f"{name}.npy", content)
    return path


def plain(array):
    stream = io.BytesIO()
    np.save(stream, array, allow_pickle=True)
    return stream.getvalue()


def test_archives(tmp_path):
    x = np.arange(6.0).reshape(2, 3)
    assert (read_npz(archive(tmp_path / "a.npz", x=plain(x)), expected="x")["x"] == x).all()
    bombs = {
        "object": plain(np.array([{1: 2}], object)),
        "header": npy_header("(99999999, 9)"),
        "text": b"hello",
        "empty": b"",
        "unclosed": b"\x93NUMPY\x01\x00\x10\x00{'shape': (68, 2,",
    }
    for name, content in bombs.items():
        with pytest.raises(ValueError, match=rf"path: expected x, but .*{name}\.npz is damaged or none"):
            read_npz(archive(tmp_path / f"{name}.npz", x=content), ["x"], expected="x")
    for name, content in {"none": b"", "half": b"PK\x03\x04hello", "array": plain(x), "words": b"hello"}.items():
        (tmp_path / f"{name}.npz").write_bytes(content)
        with pytest.raises(ValueError, match=rf"path: expected x, but .*{name}\.npz is damaged or none \(BadZipFile"):
            read_npz(tmp_path / f"{name}.npz", ["x"], expected="x")
    with pytest.raises(ValueError, match="source: expected x of at most 1 MB, but .* has 7 MB"):
        read_npz(
            archive(tmp_path / "big.npz", x=bytes(8 << 20)[100:]), ["x"], expected="x", argument="source", most_mb=1
        )


def test_a_changed_byte_in_an_archive_is_noticed(tmp_path):
    content = bytearray(archive(tmp_path / "a.npz", x=plain(np.random.default_rng(0).normal(size=99))).read_bytes())
    content[300] ^= 1
    (tmp_path / "b.npz").write_bytes(content)
    with pytest.raises(ValueError, match=r"path: expected x, but .*b\.npz is damaged"), warnings.catch_warnings():
        read_npz(tmp_path / "b.npz", ["x"], expected="x")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes have no names here")
def test_no_reader_waits_for_a_pipe(tmp_path):
    """Nobody writes into it: whoever opened it would wait for ever."""
    pipe = tmp_path / "a.wav"
    os.mkfifo(pipe)
    readers = [
        toongeo.read_image,
        toongeo.read_landmarks,
        toongeo.load_avatar,
        toongeo.load_model,
        toongeo.read_video,
        toongeo.FaceFit.load,
        toongeo.io.read_sound,
        toongeo.io.has_sound,
        toongeo.io.read_obj,
        toongeo.io.read_glb,
        toongeo.driving.read_visemes,
        toongeo.driving.read_live_link,
    ]
    for read in readers:
        with pytest.raises(ValueError, match=r"expected .*a\.wav"):
            read(pipe)
