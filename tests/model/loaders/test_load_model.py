"""Every format in its published layout: arrays, units, winding, scale; and back out of our own file bit for bit."""

import dataclasses
import json

import numpy as np
import pytest

from tests.model.loaders import layouts
from toongeo.model import MorphableModel, default_model, load_model, model_format, save_model
from toongeo.model.supply.outward import faces_inward

NO_LANDMARKS = ("bfm2009", "bfm2017", "flame_pickle", "flame_archive", "gnm")
NO_COLOURS = ("flame_pickle", "flame_archive", "gnm", "facescape", "facewarehouse", "eos")


@pytest.fixture(scope="module")
def face():
    return layouts.Face()


@pytest.fixture(scope="module")
def written(face, tmp_path_factory):
    """``written(name)``: a file in that layout; ``loaded(name)``: the model of it."""
    made = {}

    def get(name):
        if name not in made:
            pytest.importorskip("h5py") if name == "bfm2017" else None
            write, file = layouts.FILES[name]
            made[name] = write(layouts.Face(), tmp_path_factory.mktemp(name) / file)
        return made[name]

    return get


@pytest.fixture(scope="module")
def loaded(written):
    made = {}

    def get(name):
        if name not in made:
            made[name] = load_model(written(name))
        return made[name]

    return get


@pytest.mark.parametrize("name", layouts.FILES)
def test_the_format_is_told(written, name):
    formats = {"face3d": "bfm2009", "deep3d": "bfm2009", "flame_pickle": "flame", "flame_archive": "flame"}
    assert model_format(written(name)) == formats.get(name, name)


@pytest.mark.parametrize("name", layouts.FILES)
def test_the_mean_is_in_the_house_frame(face, loaded, name):
    model = loaded(name)
    origin = face.origin if name not in NO_LANDMARKS or name == "bfm2017" else (face.mean.min(0) + face.mean.max(0)) / 2
    np.testing.assert_allclose(model.mean, face.mean - origin, atol=2e-4)
    assert not faces_inward(model.mean, model.faces)
    np.testing.assert_array_equal(np.sort(np.sort(model.faces), 0), np.sort(np.sort(face.faces), 0))


@pytest.mark.parametrize("name", [name for name in layouts.FILES if name != "facewarehouse"])
def test_a_unit_of_a_mode_is_a_standard_deviation_in_mm(face, loaded, name):
    found = loaded(name).identity
    found = found[1:] if name == "facescape" else found[: layouts.K]
    np.testing.assert_allclose(found, face.identity, rtol=2e-5, atol=2e-4)
    assert len(loaded(name).identity) == {"flame_pickle": 300, "flame_archive": 300, "facescape": 7}.get(name, 6)


@pytest.mark.parametrize("name", [name for name in layouts.FILES if name != "bfm2009"])
def test_expressions(face, loaded, name):
    model = loaded(name)
    shapes = model.expression[3:] if "flame" in name else model.expression
    np.testing.assert_allclose(shapes, face.expression, rtol=2e-5, atol=2e-4)
    assert loaded("bfm2009").expression.shape == (0, layouts.N, 3)


@pytest.mark.parametrize("name", layouts.FILES)
def test_landmarks(face, loaded, name):
    model = loaded(name)
    assert model.has("landmarks") != (name in NO_LANDMARKS)
    if name not in NO_LANDMARKS:
        inner = slice(17, 68) if name == "eos" else slice(0, 68)
        np.testing.assert_array_equal(model.landmarks[inner], face.landmarks[inner])
        assert model.has("nose", "mouth", "eye_left")


@pytest.mark.parametrize("name", layouts.FILES)
def test_colours_are_srgb_in_unit_range(face, loaded, name):
    model = loaded(name)
    assert model.has("albedo") != (name in NO_COLOURS)
    if name not in NO_COLOURS:
        np.testing.assert_allclose(model.albedo_mean, face.colour, atol=1e-6)
        np.testing.assert_allclose(model.albedo, face.albedo, rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("name", ["gnm", "facescape", "facewarehouse", "eos"])
def test_texture_coordinates(face, loaded, name):
    model = loaded(name)
    corners = {tuple(f): model.uv[t] for f, t in zip(model.faces.tolist(), model.uv_faces, strict=True)}
    for triangle in model.faces[::97].tolist():
        np.testing.assert_allclose(corners[tuple(triangle)], face.uv[triangle], atol=1e-6)


@pytest.mark.parametrize("name", layouts.FILES)
def test_converted_and_loaded_again_it_is_the_same(loaded, tmp_path, name):
    same_model(loaded(name), tmp_path)


def same_model(model, folder):
    save_model(model, folder / "a.npz")
    again = load_model(folder / "a.npz")
    save_model(again, folder / "b.npz")
    assert (folder / "a.npz").read_bytes() == (folder / "b.npz").read_bytes()
    for part in dataclasses.fields(MorphableModel):
        one, other = getattr(model, part.name), getattr(again, part.name)
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype
            np.testing.assert_array_equal(one, other)
    assert again.expression_names == model.expression_names and again.n_named == model.n_named


def test_the_template_comes_back_with_all_its_parts(model, tmp_path):
    same_model(model, tmp_path)
    again = load_model(tmp_path / "a.npz")
    assert again.has("eyes", "teeth_upper", "jawOpen", "uv", "quads", "contours", "landmarks")
    np.testing.assert_array_equal(again.eyes[1].centre_modes, model.eyes[1].centre_modes)
    np.testing.assert_array_equal(again.prior.landmark_covariance, model.prior.landmark_covariance)
    np.testing.assert_array_equal(again.prior.scan_offsets, model.prior.scan_offsets)
    assert again.prior.n_principal == model.prior.n_principal
    for name, mask in model.regions.items():
        np.testing.assert_array_equal(again.regions[name], mask)
    for one, other in zip(model.contour_lines, again.contour_lines, strict=True):
        np.testing.assert_array_equal(one, other)


def test_the_jaw_of_flame_turns(face, loaded):
    """Against the definition, vertex by vertex: T. Li et al. 2017, Eq. 2-4."""
    model, arrays = loaded("flame_archive"), layouts.flame_arrays(layouts.Face())
    turn = np.array([0.3, 0.05, -0.1])
    angle = np.linalg.norm(turn)
    x, y, z = turn / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    R = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    feature = np.zeros((4, 3, 3))
    feature[1] = R - np.eye(3)
    V = 1000 * (arrays["v_template"] + arrays["posedirs"] @ feature.ravel())
    joint = 1000 * (arrays["J_regressor"] @ arrays["v_template"])[2]
    share = arrays["weights"][:, 2:3]
    expected = (1 - share) * V + share * ((V - joint) @ R.T + joint)
    found = model.posed(pose={"jaw": turn})
    np.testing.assert_allclose(found - model.mean, expected - 1000 * arrays["v_template"], atol=1e-3)
    np.testing.assert_allclose(model.posed(pose={}), model.mean, atol=1e-9)
    assert model.expression_names[:3] == ("jawOpen", "jawLeft", "jawRight") and model.n_named == 3
    np.testing.assert_allclose(model.expression[0], model.posed(pose={"jaw": (0.35, 0, 0)}) - model.mean, atol=1e-4)
    with pytest.raises(ValueError, match="pose: expected joints root, neck, jaw"):
        model.posed(pose={"chin": (0, 0, 0)})
    with pytest.raises(ValueError, match="pose: expected a rotation vector"):
        model.posed(pose={"jaw": (0, np.nan, 0)})


def test_pickle_and_archive_of_flame_are_the_same_model(loaded):
    one, other = loaded("flame_pickle"), loaded("flame_archive")
    for name in ("mean", "faces", "identity", "expression"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    np.testing.assert_array_equal(one.skinning.regressor, other.skinning.regressor)


def test_an_embedding_gives_flame_its_landmarks(face, written, tmp_path):
    triangles = np.array([np.flatnonzero((face.faces == v).any(1))[0] for v in face.landmarks])
    bary = (face.faces[triangles] == face.landmarks[:, None]) * 0.9 + 0.1 / 3
    for rows, file in ((slice(0, 68), "full.npz"), (slice(17, 68), "static.npz")):
        np.savez(tmp_path / file, lmk_face_idx=triangles[rows], lmk_b_coords=bary[rows])
        model = load_model(written("flame_archive"), landmarks=tmp_path / file)
        np.testing.assert_array_equal(model.landmarks[17:], face.landmarks[17:])
        assert model.has("contours", "landmarks", "nose")
        np.testing.assert_allclose(model.mean[model.landmarks[[36, 39, 42, 45]]].mean(0), [0, 0, 13], atol=1e-9)
    np.save(tmp_path / "full.npy", {"full_lmk_faces_idx": triangles[None], "full_lmk_bary_coords": bary[None]})
    again = load_model(written("flame_archive"), landmarks=tmp_path / "full.npy")
    np.testing.assert_array_equal(again.landmarks[17:], face.landmarks[17:])


def test_landmarks_of_gnm_and_of_lists(face, written, tmp_path):
    table = layouts.gnm_landmarks(face, tmp_path / "landmarks.npz")
    np.testing.assert_array_equal(load_model(written("gnm"), landmarks=table).landmarks[17:], face.landmarks[17:])
    (tmp_path / "picked.json").write_text(json.dumps(face.landmarks.tolist()))
    picked = load_model(written("bfm2009"), landmarks=tmp_path / "picked.json")
    np.testing.assert_array_equal(picked.landmarks[17:], face.landmarks[17:])
    np.savez(tmp_path / "few.npz", lmk_face_idx=np.arange(5), lmk_b_coords=np.ones((5, 3)))
    with pytest.raises(ValueError, match="holds 5 landmarks"):
        load_model(written("gnm"), landmarks=tmp_path / "few.npz")


def test_parts_of_gnm(face, loaded):
    model = loaded("gnm")
    np.testing.assert_array_equal(model.quads, face.quads)
    np.testing.assert_array_equal(np.flatnonzero(model.region("tongue")), range(40))
    np.testing.assert_array_equal(model.mirror, np.arange(layouts.N)[::-1])
    assert model.n_named == 0 and model.expression_names[0] == "lower_face_region_0" and not model.has("expression")


def test_facescape_without_statistics_takes_the_first_coefficient_for_the_mean(written, loaded, tmp_path):
    with np.load(written("facescape"), allow_pickle=True) as z:
        arrays = {name: z[name] for name in z.files if name not in ("id_mean", "id_var", "sym_dict")}
    np.savez(tmp_path / "old.npz", **arrays)
    model, known = load_model(tmp_path / "old.npz"), loaded("facescape")
    corners = model.mean[model.landmarks[[36, 45]]]
    assert np.linalg.norm(corners[1] - corners[0]) == pytest.approx(90)
    ratio = model.identity[1:].std() / known.identity[1:].std()
    np.testing.assert_allclose(model.identity[1:], ratio * known.identity[1:], rtol=1e-4, atol=1e-4)


def test_colours_of_facescape_are_blue_first(written, tmp_path):
    rng = np.random.default_rng(3)
    mean, modes = rng.uniform(0, 255, (layouts.N, 3)), rng.normal(0, 20, (layouts.N, 3, 2))
    with np.load(written("facescape"), allow_pickle=True) as z:
        arrays = {name: z[name] for name in z.files if name != "sym_dict"}
    core = modes.reshape(-1, 2)
    np.savez(tmp_path / "coloured.npz", **arrays, color_bm_mean=mean.ravel(), color_bm_core=core)
    model = load_model(tmp_path / "coloured.npz")
    np.testing.assert_allclose(model.albedo_mean, mean[:, ::-1] / 255, atol=1e-6)
    np.testing.assert_allclose(model.albedo, modes[:, ::-1].transpose(2, 0, 1) / 255, atol=1e-6)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"shape_bm_core": np.ones((6, 2))}, "shape_bm_core"),
        ({"shape_bm_core": np.ones((7, 2, 2))}, "shape_bm_core"),
        ({"id_mean": np.ones(3)}, "means and variances"),
        ({"id_var": np.full(layouts.K + 1, -1.0)}, "means and variances"),
        ({"id_mean": None, "lm_list_v16": None}, "68 landmarks"),
        ({"id_mean": None, "lm_list_v16": np.arange(68) + layouts.N}, "68 landmarks"),
    ],
)
def test_a_facescape_that_does_not_fit_together_is_refused(written, tmp_path, changed, told):
    with np.load(written("facescape"), allow_pickle=True) as z:
        arrays = {name: z[name] for name in z.files if name != "sym_dict"} | changed
    np.savez(tmp_path / "bad.npz", **{name: value for name, value in arrays.items() if value is not None})
    with pytest.raises(ValueError, match=told):
        load_model(tmp_path / "bad.npz")


@pytest.mark.parametrize(
    ("name", "change", "told"),
    [
        ("identity", lambda a: a[:, 1:], "identity: expected"),
        ("faces", lambda a: a.astype(float), "faces: expected"),
        ("mean", lambda a: np.where(a == a.max(), np.nan, a), "mean: expected finite"),
        ("faces", lambda a: a + len(a), "faces: expected vertices in"),
        ("landmarks", lambda a: a[:67], "landmarks: expected 68 rows"),
        ("contour_lines", lambda a: a + 10**6, "contour_lines: expected numbers in range"),
        ("contour_starts", lambda a: a[::-1], "contour_starts: expected 18 ascending"),
        ("eye0_centre_modes", lambda a: a[1:], "eyes: expected modes"),
        ("eye1_uv", lambda a: a[1:], "eyes: expected a mesh"),
    ],
)
def test_a_file_of_ours_that_does_not_fit_together_is_refused(tmp_path, name, change, told):
    save_model(default_model(), tmp_path / "good.npz")
    with np.load(tmp_path / "good.npz") as z:
        arrays = dict(z)
    np.savez(tmp_path / "bad.npz", **arrays | {name: change(arrays[name])})
    with pytest.raises(ValueError, match=told):
        load_model(tmp_path / "bad.npz")


def test_people_of_facewarehouse_span_the_modes(face, loaded):
    model = loaded("facewarehouse")
    flat, truth = model.identity.reshape(len(model.identity), -1), face.identity.reshape(layouts.K, -1)
    assert len(flat) == layouts.K
    np.testing.assert_allclose(np.linalg.lstsq(flat.T, truth.T, rcond=None)[1], 0, atol=1)
    gram = flat @ flat.T
    np.testing.assert_allclose(gram, np.diag(np.diag(gram)), atol=1e-3 * gram.max())


def test_the_folder_of_facewarehouse(face, tmp_path):
    folder = layouts.facewarehouse_folder(face, tmp_path / "fw")
    model = load_model(folder)
    assert model_format(folder) == "facewarehouse" and model.has("uv") and len(model.identity) == 2
    np.testing.assert_allclose(model.expression, face.expression, atol=1e-3)
    assert np.ptp(model.mean[:, 1]) == pytest.approx(np.ptp(face.mean[:, 1]), rel=0.05)  # centimetres became mm


def test_contours_of_eos_are_regions_and_jaw_points_slide(loaded):
    model = loaded("eos")
    assert model.has("contours", "contour_right", "contour_left")
    assert np.flatnonzero(model.region("contour_right")).tolist() == [3, 4]
    for line in model.contour_lines:
        assert len(line) == 1 or (np.diff(model.mean[line, 2]) < 5).all()


def test_a_folder_of_meshes_is_blendshapes_or_people(face, tmp_path):
    (tmp_path / "neutral.obj").write_text(layouts.obj_text(face.mean, face))
    (tmp_path / "jawOpen.obj").write_text(layouts.obj_text(face.mean + face.expression[0], face))
    (tmp_path / "mouthPucker.obj").write_text(layouts.obj_text(face.mean + face.expression[1], face))
    model = load_model(tmp_path)
    assert model.expression_names == ("jawOpen", "mouthPucker") and model.has("jawOpen", "uv", "quads")
    np.testing.assert_allclose(model.expression, face.expression[:2], atol=1e-4)
    (tmp_path / "neutral.obj").rename(tmp_path / "anna.obj")
    assert len(load_model(tmp_path).identity) == 2  # without a neutral face these are people
    assert load_model(tmp_path, format="people").expression_names == ()
    with pytest.raises(ValueError, match=r"expected a file neutral.obj"):
        load_shapes(tmp_path, kind="blendshapes")
    (tmp_path / "other.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(ValueError, match="another topology"):
        load_model(tmp_path)


def load_shapes(*arguments, **options):
    from toongeo.model.loaders.load_shapes import load_shapes

    return load_shapes(*arguments, **options)


def test_morph_targets_of_a_glb(face, tmp_path):
    from toongeo.io import Scene, SceneMesh, write_glb

    mesh = SceneMesh(
        name="head", vertices=face.mean, faces=face.faces, uv=face.uv, uv_faces=face.faces,
        targets=face.expression[:2], target_names=("jawOpen", "mouthLeft"),
    )  # fmt: skip
    write_glb(tmp_path / "head.glb", Scene((mesh,)))
    model = load_model(tmp_path / "head.glb")
    assert model.expression_names == ("jawOpen", "mouthLeft") and model.has("uv")
    assert np.ptp(model.mean[:, 1]) == pytest.approx(np.ptp(face.mean[:, 1]), abs=1e-3)


def test_what_is_no_model_is_refused(tmp_path):
    (tmp_path / "a.txt").write_text("hello")
    with pytest.raises(ValueError, match="path: expected a model in one of the formats toongeo, bfm2009"):
        load_model(tmp_path / "a.txt")
    with pytest.raises(ValueError, match="path: expected a model"):
        load_model(tmp_path)
    with pytest.raises(OSError, match="missing"):
        load_model(tmp_path / "missing.npz")
    with pytest.raises(ValueError, match="format: expected one of"):
        load_model(tmp_path / "a.txt", format="vrm")
    with pytest.raises(ValueError, match="ends in .npz"):
        save_model(None, tmp_path / "model.bin")
    (tmp_path / "x.bin").write_bytes(b"")
    with pytest.raises(ValueError, match="landmarks: expected a table"):
        load_model(tmp_path / "x.bin")
