"""An avatar comes back from its GLB, and nothing else does."""

import json
import re
import struct
import tracemalloc
import zlib
from dataclasses import fields, is_dataclass, replace
from hashlib import sha256

import numpy as np
import pytest

from toongeo import load_avatar
from toongeo.avatar.state import decode_state, encode_state
from toongeo.io import read_glb
from toongeo.model import MorphableModel
from toongeo.pipeline import LandmarkNoise, RigReport
from toongeo.pipeline.fit.face_fit import PhotometricReport
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera

LENGTHS = {"face.vertices", "rig.neutral", "rig.deltas", "rig.gaze"}  # all else is exact


def differences(a, b, where=""):
    """Path and greatest difference of every array, number and text of two values; fails where kinds differ."""
    assert type(a) is type(b), where
    if isinstance(a, MorphableModel):
        assert a is b, where
    elif is_dataclass(a):
        for field in fields(a):
            yield from differences(getattr(a, field.name), getattr(b, field.name), f"{where}.{field.name}".strip("."))
    elif isinstance(a, dict):
        assert list(a) == list(b), where
        for key in a:
            yield from differences(a[key], b[key], f"{where}.{key}")
    elif isinstance(a, tuple):
        assert len(a) == len(b), where
        for number, (x, y) in enumerate(zip(a, b, strict=True)):
            yield from differences(x, y, f"{where}[{number}]")
    elif isinstance(a, np.ndarray):
        assert (a.dtype, a.shape) == (b.dtype, b.shape), where
        yield where, float(np.abs(a.astype(float) - b).max(initial=0))
    elif "seconds" in where.split("."):
        assert b == 0.0, where  # times are not kept
    else:
        yield where, 0.0 if a == b or a != a else np.inf


@pytest.fixture(scope="module")
def plain(avatar, tmp_path_factory):
    path = tmp_path_factory.mktemp("load") / "plain.glb"
    avatar.save(path)
    return path


@pytest.fixture(scope="module")
def small(avatar, tmp_path_factory):
    path = tmp_path_factory.mktemp("load") / "small.glb"
    avatar.save(path, quantize=True, texture="jpeg", animation=None)
    return path


def test_every_field_comes_back(avatar, plain):
    found = dict(differences(avatar, load_avatar(plain)))
    assert {"fit.identity", "fit.camera.rotation", "fit.report.rms_px", "parse.labels", "parse.confidence"} < set(found)
    assert {"rig.pose", "eyes.centres", "texture", "report.quality.folded", "eyes.pose"} < set(found)
    assert {where for where, most in found.items() if most > 0} <= LENGTHS
    assert max(found.values()) <= 1e-4  # mm: less than 1e-6 of a head


def test_errors_do_not_add_up(plain, tmp_path):
    avatar = again = load_avatar(plain)
    for _ in range(3):
        again.save(tmp_path / "again.glb")
        again = load_avatar(tmp_path / "again.glb")
    assert max(most for _, most in differences(avatar, again)) <= 3e-5


def test_it_moves_and_looks_as_before(avatar, plain):
    loaded = load_avatar(plain)
    weights = {"jawOpen": 0.7, "eyeLookOutLeft": 1.0, "tongueOut": 0.4}
    np.testing.assert_allclose(loaded.vertices(weights), avatar.vertices(weights), atol=3e-4)
    np.testing.assert_array_equal(loaded.eye_vertices(0, weights), avatar.eye_vertices(0, weights))
    difference = np.abs(loaded.render(weights, 96).astype(int) - avatar.render(weights, 96))
    assert difference.mean() < 0.05


def test_what_only_some_fits_have_comes_back_too(avatar, tmp_path):
    """Light and albedo of a photometric fit, a perspective camera, gaze that moves the lids."""
    rng = np.random.default_rng(1)
    camera = PerspectiveCamera(900.0, np.eye(3), [1.0, 2.0, -600.0], [160.0, 200.0])
    photometric = PhotometricReport(0.1, 0.2, 0.3, 0.4, "FTOL_REACHED", 2, 30, 0.5)
    fit = replace(avatar.fit, camera=camera, albedo=rng.random(9), light=rng.random((9, 3)), photometric=photometric)
    gaze = (rng.random(avatar.rig.gaze.shape) * (rng.random(avatar.rig.gaze.shape) > 0.9)).astype(np.float32)
    other = replace(avatar, fit=fit, face=replace(avatar.face, fit=fit), rig=replace(avatar.rig, gaze=gaze))
    other.save(tmp_path / "a.glb")
    found = dict(differences(other, load_avatar(tmp_path / "a.glb")))
    assert {where for where, most in found.items() if most > 0} <= LENGTHS and max(found.values()) <= 1e-4


def test_names_may_be_anything(avatar, tmp_path):
    names = ("../../evil", '"><script>alert(1)</script>', "顔 \\ \n\0", "\ud800", *avatar.names[4:])
    other = replace(avatar, rig=replace(avatar.rig, names=names))
    other.save(tmp_path / "a.glb", animation=None)
    assert load_avatar(tmp_path / "a.glb").rig.names == names


def test_a_quantized_file_says_how_far_it_is_off(avatar, tmp_path):
    avatar.save(tmp_path / "a.glb", quantize=True)
    found = dict(differences(avatar, load_avatar(tmp_path / "a.glb")))
    assert {where for where, most in found.items() if most > 0} <= LENGTHS | {"parse.confidence"}
    assert found["parse.confidence"] <= 0.5 / 63 + 1e-6
    assert found["rig.neutral"] <= 1e-4 and 0.01 < found["rig.deltas"] <= 0.055  # a coordinate, mm


def test_other_textures(avatar, small, tmp_path):
    jpeg = load_avatar(small).texture
    assert jpeg.shape == avatar.texture.shape and 0 < np.abs(jpeg.astype(int) - avatar.texture).mean() < 3
    avatar.save(tmp_path / "a.glb", texture=None)
    plain = load_avatar(tmp_path / "a.glb").texture
    assert plain.shape == (8, 8, 3) and len(np.unique(plain.reshape(-1, 3), axis=0)) == 1


def test_an_avatar_of_another_model_needs_that_model(avatar, tmp_path):
    model = replace(avatar.face.model, mean=avatar.face.model.mean + 1.0)
    fit = replace(avatar.fit, model=model)
    other = replace(avatar, fit=fit, face=replace(avatar.face, model=model, fit=fit))
    other.save(tmp_path / "a.glb")
    with pytest.raises(ValueError, match="cannot be loaded: model: expected the model with which"):
        load_avatar(tmp_path / "a.glb")
    assert load_avatar(tmp_path / "a.glb", model=model).face.model is model
    fewer = replace(model, faces=model.faces[:-1], uv_faces=model.uv_faces[:-1])
    with pytest.raises(ValueError, match="model: expected the model with which the avatar was made, got another"):
        load_avatar(tmp_path / "a.glb", model=fewer)


@pytest.mark.parametrize("options", [{"loadable": False}, {"crop": "face"}, {"names": "arkit"}])
def test_files_without_what_is_needed_are_refused(avatar, tmp_path, options):
    avatar.save(tmp_path / "a.glb", **options)
    with pytest.raises(ValueError, match=r"path: expected a GLB that Avatar\.save wrote with loadable=True"):
        load_avatar(tmp_path / "a.glb")


def test_files_of_others_are_refused(tmp_path):
    with pytest.raises(OSError, match="none"):
        load_avatar(tmp_path / "none.glb")
    (tmp_path / "a.glb").write_bytes(b"")
    with pytest.raises(ValueError, match="path: expected a GLB"):
        load_avatar(tmp_path / "a.glb")
    (tmp_path / "a.glb").write_bytes(b'<html>"><script>' * 10)
    with pytest.raises(ValueError, match="path: expected a GLB"):
        load_avatar(tmp_path / "a.glb")


def signed(content):
    """The same bytes with a checksum that fits them."""
    stands = re.search(rb'"sha256":"[0-9a-f]{64}"', content)
    if stands is None:
        return content
    empty = content.replace(stands[0], b'"sha256":"' + b"0" * 64 + b'"', 1)
    return empty.replace(b"0" * 64, sha256(empty).hexdigest().encode(), 1)


def with_json(content, edited):
    """A GLB with another JSON chunk."""
    size = struct.unpack_from("<I", content, 12)[0]
    text = edited(content[20 : 20 + size])
    text += b" " * (-len(text) % 4)
    rest = content[20 + size :]
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    return signed(head + struct.pack("<I4s", len(text), b"JSON") + text + rest)


def test_the_helper_signs_as_the_writer_does(small):
    content = small.read_bytes()
    assert signed(content) == content == with_json(content, lambda text: text.rstrip(b" "))
    assert read_glb(small).intact


def test_cut_and_changed_files_are_refused(small, tmp_path):
    content, rng = small.read_bytes(), np.random.default_rng(0)
    size = struct.unpack_from("<I", content, 12)[0]
    damaged = []
    for end in [*range(0, 32, 3), *rng.integers(0, len(content), 25)]:
        damaged.append(content[:end])
        damaged.append(content[:8] + struct.pack("<I", max(end, 12)) + content[12:end])  # tells its true length
    for at in [*range(0, 24), *rng.integers(0, size, 20), *rng.integers(0, len(content), 20)]:
        changed = bytearray(content)
        changed[at] ^= 1 << int(rng.integers(8))
        damaged.append(bytes(changed))
    for wrong in damaged:
        (tmp_path / "a.glb").write_bytes(wrong)
        with pytest.raises(ValueError, match="path: "):
            load_avatar(tmp_path / "a.glb")


def test_forged_files_give_an_avatar_or_an_error(small, tmp_path):
    """With a checksum that fits, any number or text of the JSON may be anything."""
    content, rng = small.read_bytes(), np.random.default_rng(0)
    size = struct.unpack_from("<I", content, 12)[0]
    text = content[20 : 20 + size]
    values = [found.span() for found in re.finditer(rb'(?<=[:\[,])(-?\d[\d.e-]*|"[^"]*")(?=[,\]}])', text)]
    forged = [b"-1", b"0", b"1e400", b"NaN", b"99999999999", b"2147483647", b"null", b'"x"', b"[]", b"{}", b"1.5"]
    refused = 0
    for number in range(60):
        start, end = values[int(rng.integers(len(values)))]
        new = forged[number % len(forged)]
        (tmp_path / "a.glb").write_bytes(with_json(content, lambda text: text[:start] + new + text[end:]))  # noqa: B023
        try:
            load_avatar(tmp_path / "a.glb")
        except ValueError:
            refused += 1
    assert refused > 20


def test_a_file_that_announces_much_gets_no_memory(small, tmp_path):
    content = small.read_bytes()
    for edited in (
        lambda text: re.sub(rb'"count":\d+', b'"count":4000000000', text),
        lambda text: re.sub(rb'"count":\d+', b'"count":900000', text),
        lambda text: b'{"accessors":' + b"[" * 100_000,
    ):
        (tmp_path / "a.glb").write_bytes(with_json(content, edited))
        tracemalloc.start()
        with pytest.raises(ValueError, match="path: "):
            load_avatar(tmp_path / "a.glb")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 20 * len(content)


STATE = {"a": 1.5, "b": None, "c": ("x", np.arange(3)), "d": {"e": [True]}, "f": np.zeros((0, 2), np.float32)}


def test_a_state_comes_back(model):
    back = decode_state(encode_state(STATE, {}, model), {}, model)
    assert dict(differences(back["c"], STATE["c"])) == {"[0]": 0.0, "[1]": 0.0}
    assert back["a"] == 1.5 and back["b"] is None and back["d"] == {"e": [True]}
    assert back["f"].shape == (0, 2) and back["f"].dtype == np.float32


@pytest.mark.parametrize("dtype", ["?", "u1", "i2", "i4", "f4", "i8", "f8"])
@pytest.mark.parametrize("shape", [(), (5,), (0,), (3, 4), (0, 4), (4, 0), (1, 1), (2, 3, 4)])
def test_arrays_come_back_to_the_last_bit(model, dtype, shape):
    bits = np.random.default_rng(0).integers(0, 256, (*shape, 8), dtype=np.uint8)
    array = (bits[..., 0] > 99) if dtype == "?" else np.frombuffer(bits.tobytes(), dtype)[: np.prod(shape, dtype=int)]
    array = np.array(array).reshape(shape)
    back = decode_state(encode_state({"a": array}, {}, model), {}, model)["a"]
    assert (back.dtype, back.shape, back.tobytes()) == (array.dtype, array.shape, array.tobytes())


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (object(), r"a: expected numbers, texts, arrays or .*, got <class 'object'>"),
        (np.array([object()]), "a: expected an array of numbers, got object"),
        ({1: 2}, r"a: expected numbers, texts, arrays or .*, got <class 'dict'>"),
    ],
)
def test_values_that_cannot_be_told_are_refused(value, message, model):
    with pytest.raises(ValueError, match=message):
        encode_state({"a": value}, {}, model)


def packed(head, size=None):
    text = json.dumps(head).encode()
    data = len(text).to_bytes(8, "little") + text
    return (len(data) if size is None else size).to_bytes(8, "little") + zlib.compress(data)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0" * 20,
        (1 << 40).to_bytes(8, "little") + zlib.compress(b"x"),
        (100).to_bytes(8, "little") + zlib.compress(bytes(10**8)),  # grows to more than it announces
        packed({"version": 2}),
        packed({"version": 1, "model": 0, "state": {}, "arrays": []}, 1 << 20),
        packed({"version": 1, "model": 0, "state": {}, "arrays": [["<f8", [1 << 40, 1 << 40]]]}),
        packed({"version": 1, "model": 0, "state": {}, "arrays": [["O", [1]]]}),
        packed({"version": 1, "model": 0, "state": {}, "arrays": [["<f8", [-1]]]}),
        packed({"version": 1, "model": 0, "state": {}, "arrays": 5}),
    ],
)
def test_other_bytes_are_no_state(content, model):
    tracemalloc.start()
    with pytest.raises(ValueError, match="content: expected the state of an avatar, got other bytes"):
        decode_state(content, {}, model)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1 << 22


def test_only_classes_of_the_library_are_made(model):
    content = encode_state({"a": None}, {}, model)
    head = json.loads(zlib.decompress(content[8:])[8:])
    for node in ({"Popen": {"args": "ls"}}, {"Rig": {}}, {"array": 3}, {"known": "x"}, {"a": 1, "b": 2}, {"eye": "x"}):
        with pytest.raises(ValueError, match="content: expected the state of an avatar"):
            decode_state(packed({**head, "state": {"a": node}}), {}, model)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (RigReport(seconds="long"), "RigReport.seconds: expected float, got str"),
        (RigReport(matched=True), "RigReport.matched: expected float . None, got bool"),
        (ScaledOrthographicCamera(1.0, np.eye(3), np.zeros(2)), None),
        (LandmarkNoise(sigma=0.1, smoothed=1, rejected=()), "LandmarkNoise.smoothed: expected bool, got int"),
        (LandmarkNoise(sigma=0.1, smoothed=True, rejected=("a",)), "LandmarkNoise.rejected: expected tuple"),
    ],
)
def test_fields_of_other_types_are_refused(model, wrong, message):
    content = encode_state({"part": wrong}, {}, model)
    if message is None:
        assert decode_state(content, {}, model)["part"].scale == 1.0
        return
    with pytest.raises(ValueError, match=message):
        decode_state(content, {}, model)
