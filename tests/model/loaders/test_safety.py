"""Files of unknown origin: nothing is executed or unpacked without bounds, and all that is raised is ValueError."""

import collections
import os
import pickle
import resource
import zipfile

import numpy as np
import pytest

from tests.model.loaders import layouts
from tests.model.loaders.mutations import mutated
from toongeo.model import default_model, load_model, save_model
from toongeo.model.loaders.files.read_mat import read_mat
from toongeo.model.loaders.files.read_pickle import plain, unpickled
from toongeo.reading.read_npz import read_npz

MUTANTS = 200  # a format; benchmarks/fuzz_models.py makes thousands


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    made = {}

    def get(name):
        if name not in made:
            pytest.importorskip("h5py") if name == "bfm2017" else None
            folder = tmp_path_factory.mktemp(name)
            write, file = layouts.FILES[name]
            made[name] = write(layouts.Face(), folder / file)
        return made[name]

    return get


@pytest.mark.parametrize("name", [*layouts.FILES, "own"])
def test_damaged_files_are_refused_or_read_but_never_more(contents, tmp_path, name):
    if name == "own":
        source = tmp_path / "own.npz"
        save_model(load_model(contents("deep3d")), source)
    else:
        source = contents(name)
    content, rng = source.read_bytes(), np.random.default_rng(7)
    target = tmp_path / source.name
    if name == "eos":
        for beside in source.parent.iterdir():
            (tmp_path / beside.name).write_bytes(beside.read_bytes())
    formats = {"face3d": "bfm2009", "deep3d": "bfm2009", "flame_pickle": "flame", "flame_archive": "flame"}
    kind = {**formats, "own": "toongeo"}.get(name, name)
    refused = 0
    for _ in range(MUTANTS):
        target.write_bytes(mutated(content, rng))
        try:
            model = load_model(target, format=kind)
        except (ValueError, OSError):
            refused += 1
        else:
            assert np.isfinite(model.mean).all() and 0 <= model.faces.min() <= model.faces.max() < len(model.mean)
    assert refused > 0.3 * MUTANTS


class Shell:
    def __reduce__(self):
        return os.system, ("touch " + self.mark,)


def evil(mark, kind):
    shell = Shell()
    shell.mark = str(mark)
    return {
        "alone": lambda: pickle.dumps(shell),
        "in the dictionary": lambda: pickle.dumps({"v_template": shell, "f": np.arange(3)}),
        "nested": lambda: pickle.dumps([{"a": ({"b": [shell]},)}]),
        "old protocol": lambda: pickle.dumps(shell, protocol=0),
        "eval": lambda: b'c__builtin__\neval\n(S\'__import__("os").system("touch %s")\'\ntR.' % str(mark).encode(),
        "getattr": lambda: b"\x80\x04\x8c\x08builtins\x8c\x07getattr\x93.",
        "through numpy": lambda: b"cnumpy.testing._private.utils\nrunstring\n(S'x'\ntR.",
        "numpy's own loader": lambda: b"cnumpy\nload\n(S'x'\ntR.",
        "dotted": lambda: b"\x80\x04\x8c\x05numpy\x8c\x0cndarray.dump\x93.",
        "partial": lambda: pickle.dumps(collections.Counter),
        "persistent": lambda: b"Pid\n.",
        "registry": lambda: b"\x80\x02\x82\x01.",
        "instance": lambda: b"(S'touch'\nios\nsystem\n.",
    }[kind]()


@pytest.mark.parametrize(
    "kind",
    ["alone", "in the dictionary", "nested", "old protocol", "eval", "getattr", "through numpy", "numpy's own loader",
     "dotted", "partial", "persistent", "registry", "instance"],
)  # fmt: skip
def test_a_malicious_pickle_executes_nothing(tmp_path, kind):
    (tmp_path / "generic_model.pkl").write_bytes(evil(tmp_path / "executed", kind))
    with pytest.raises(ValueError, match=r"which is refused; nothing was executed|has no step"):
        load_model(tmp_path / "generic_model.pkl")
    assert not (tmp_path / "executed").exists()


def test_a_malicious_table_executes_nothing(contents, tmp_path):
    for name in ("table.pkl", "table.npy"):
        head = b"" if name.endswith("pkl") else b"\x93NUMPY\x01\x00\x02\x00 \n"
        (tmp_path / name).write_bytes(head + evil(tmp_path / "executed", "alone"))
        with pytest.raises(ValueError, match="nothing was executed"):
            load_model(contents("flame_archive"), landmarks=tmp_path / name)
    assert not (tmp_path / "executed").exists()


@pytest.mark.parametrize("protocol", range(6))
def test_plain_arrays_of_any_protocol_are_read(protocol):
    kinds = ("<f8", ">f4", "<i4", "u1", "?")
    arrays = {kind: np.asfortranarray(np.arange(6).reshape(2, 3).astype(kind)) for kind in kinds}
    content = pickle.dumps({**arrays, "scalar": np.float64(3), "list": [1, "a", None]}, protocol=protocol)
    found = plain(unpickled(content))
    for kind, array in arrays.items():
        np.testing.assert_array_equal(found[kind], array)
    assert found["scalar"] == 3 and found["list"] == [1, "a", None]


def test_pickles_that_lie_about_their_arrays_are_refused():
    array = np.arange(4.0)
    content = pickle.dumps({"a": array}, protocol=2)
    with pytest.raises(ValueError, match="bytes"):
        plain(unpickled(content.replace(b"K\x04\x85", b"K\x05\x85")))
    objects = pickle.dumps({"a": np.array([{}, {}], object)}, protocol=2)
    assert plain(unpickled(objects)) == {"a": [{}, {}]}
    deep = b"(" + b"".join(b"\x85" for _ in range(30000)) + b"."
    with pytest.raises(ValueError, match="no more than 20000 steps"):
        unpickled(b"\x80\x02N" + deep[1:])
    with pytest.raises(ValueError, match="no more than 20000 steps"):
        unpickled(b"\x80\x02Nr\xff\xff\xff\x7f.")
    laughs = b"\x80\x02]" + b"".join(b"q%c](h%ch%ce" % (i, i, i) for i in range(60)) + b"."
    assert isinstance(plain(unpickled(laughs)), list)  # 2^60 parts, of which each is looked at once


def npy(shape, data=b"", dtype="<f8"):
    head = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}"
    head += " " * (63 - (10 + len(head)) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head.encode() + data


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (npy((10**12,)), r"the shape is \(1000000000000,\), but 0 bytes follow"),
        (npy((2**62, 8)), "but 0 bytes follow"),
        (npy((-1, 3)), r"the shape is \(-1, 3\)"),
        (npy((4,), bytes(40)), r"the shape is \(4,\), but more bytes follow"),
        (npy((1,), bytes(8), "|O"), r"array 'mean.npy': got object"),
        (b"\x93NUMPY\x09\x00rubbish", "version .* is not known here"),
        (b"nothing", "is damaged or none"),
    ],
)
def test_arrays_that_lie_about_their_size_are_refused(tmp_path, content, message):
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("mean.npy", content)
    with pytest.raises(ValueError, match=message):
        read_npz(tmp_path / "a.npz", ["mean"], expected="a model")


def test_a_zip_bomb_is_not_unpacked(tmp_path):
    size = 1 << 27
    with (
        zipfile.ZipFile(tmp_path / "bomb.npz", "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("mean.npy", "w") as f,
    ):
        f.write(npy((size // 8,)))
        for _ in range(size >> 20):
            f.write(bytes(1 << 20))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(ValueError, match="path: expected a model of at most 100 times .*bomb.npz announces 1342"):
        read_npz(tmp_path / "bomb.npz", ["mean"], expected="a model")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 64 * 1024  # kB


def test_a_bomb_in_a_matlab_file_is_not_unpacked(tmp_path):
    import zlib

    packed = zlib.compress(bytes(1 << 26), 9)
    element = (15).to_bytes(4, "little") + len(packed).to_bytes(4, "little") + packed
    (tmp_path / "a.mat").write_bytes(b"MATLAB 5.0".ljust(126) + b"IM" + element)
    with pytest.raises(ValueError, match="path: expected a MATLAB 5 file, but .* is damaged or none"):
        read_mat(tmp_path / "a.mat")


def test_arrays_of_matlab_are_those_of_scipy(tmp_path):
    import scipy.io

    arrays = {
        "a": np.arange(12.0).reshape(3, 4),
        "b": np.array([[1, -2]], np.int16),
        "c": np.zeros((0, 3)),
        "d": np.uint8([[7]]),
    }
    for compress in (False, True):
        scipy.io.savemat(
            tmp_path / "a.mat",
            {**arrays, "s": {"x": arrays["a"], "text": "no numbers"}, "t": "text"},
            do_compression=compress,
        )
        found = read_mat(tmp_path / "a.mat")
        assert set(found) == {*arrays, "s"}
        for name, array in arrays.items():
            assert found[name].dtype == array.dtype
            np.testing.assert_array_equal(found[name], array)
        np.testing.assert_array_equal(found["s"]["x"], arrays["a"])
    (tmp_path / "a.mat").write_bytes(b"MATLAB 7.3 MAT-file")
    with pytest.raises(ValueError, match="no header of MATLAB 5"):
        read_mat(tmp_path / "a.mat")


def changed(contents, tmp_path, **changes):
    """A saved model of which some arrays were replaced."""
    save_model(load_model(contents("deep3d")), tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as z:
        arrays = dict(z) | changes
    np.savez(tmp_path / "b.npz", **arrays)
    return tmp_path / "b.npz"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mean": np.full((550, 3), np.nan)}, "mean: expected finite numbers"),
        ({"identity": np.full((6, 550, 3), np.inf, np.float32)}, "identity: expected finite numbers"),
        ({"faces": np.full((1008, 3), 550)}, "faces: expected vertices in 0..549"),
        ({"faces": np.full((1008, 3), -1)}, "faces: expected vertices in 0..549"),
        ({"faces": np.zeros((1008, 4), int)}, "faces: expected"),
        ({"mean": np.zeros((550, 2))}, "is damaged or none"),
        ({"landmarks": np.zeros(5, int)}, "landmarks: expected 68 rows"),
        ({"contour_starts": np.arange(18)[::-1]}, "contour_starts: expected 18 ascending places"),
        ({"toongeo_model": np.array('{"version": 9}')}, "expected version 1 of a model, got 9"),
        ({"toongeo_model": np.array("[")}, "is damaged or none"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(contents, tmp_path, changes, message):
    with pytest.raises(ValueError, match=message):
        load_model(changed(contents, tmp_path, **changes))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"mean": np.full((550, 3), np.nan)}, "mean: expected finite numbers"),
        ({"mean": np.zeros((550, 2))}, r"mean: expected numbers of shape \(None, 3\)"),
        ({"faces": np.full((3, 3), 550)}, r"faces: expected vertices in 0..549, got 550"),
        ({"faces": np.zeros((0, 3), int)}, "faces: expected at least one"),
        ({"faces": np.zeros((3, 3))}, r"faces: expected \(m, 3\) whole numbers"),
        ({"identity": np.zeros((2, 5, 3))}, r"identity: expected modes \(k, 550, 3\)"),
        ({"identity": np.full((2, 550, 3), np.nan)}, "identity: expected finite"),
        ({"landmarks": np.arange(5)}, r"landmarks: expected 68 vertices \(iBUG-68\) or none, got 5"),
        ({"landmarks": np.arange(68) + 500}, "landmarks: expected vertices in 0..549"),
        ({"unit": 0.0}, "unit: expected millimetres a unit"),
        ({"unit": 1e9}, "mean: expected a head in mm"),
        ({"expression_names": ("a",)}, "expression_names: expected at most 0 names"),
        ({"expression": np.zeros((2, 550, 3)), "expression_names": ("a", "a")}, "each name once"),
        ({"n_named": 3}, "n_named: expected 0 to 0"),
        ({"regions": {"face": np.zeros(3, bool)}}, r"regions: expected masks \(550,\)"),
        ({"mirror": np.arange(3)}, r"mirror: expected \(550,\)"),
        ({"uv": np.zeros((9, 2)), "uv_faces": np.zeros((3, 3), int)}, r"uv_faces: expected shape \(1008, 3\)"),
        ({"contour_lines": (np.arange(3),)}, "contour_lines: expected 17"),
        ({"mean": np.zeros((550, 3)), "unit": "auto"}, "mean: expected a face, got points at one place"),
    ],
)  # fmt: skip
def test_arrays_of_a_new_model_are_checked(arguments, message):
    from toongeo.model import MorphableModel

    face = layouts.Face()
    given = {"mean": face.mean, "faces": face.faces, **arguments}
    with pytest.raises(ValueError, match=message):
        MorphableModel.from_arrays(**given)


def test_a_file_cut_anywhere_is_refused(contents, tmp_path):
    for name in ("flame_pickle", "bfm2009", "gnm"):
        content = contents(name).read_bytes()
        for share in (0.0, 0.1, 0.5, 0.9, 0.999):
            target = tmp_path / contents(name).name
            target.write_bytes(content[: int(share * len(content))])
            with pytest.raises((ValueError, OSError)):
                load_model(target)


def test_without_h5py_its_extra_is_named(contents, monkeypatch):
    path = contents("bfm2017")
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(ImportError, match="needs the extra models: pip install"):
        load_model(path)


def test_random_people_are_about_the_likeliest(model):
    rng = np.random.default_rng(3)
    people = np.array([model.sample(rng, sigma=0.5) for _ in range(2000)])
    np.testing.assert_allclose(people.mean(0), default_model().prior.mean, atol=0.06)
    np.testing.assert_allclose(people[:, : model.prior.n_principal].std(0), 0.5, atol=0.05)
    assert not np.ptp(people[:, model.prior.n_principal :], axis=0).any()
