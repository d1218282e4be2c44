"""Small files of face models in their published layouts: random content on a plausible face."""

import io
import json
import pickle
import struct
import sys
import types

import numpy as np

from toongeo.model import default_model

ROWS, COLUMNS = 22, 25
N = ROWS * COLUMNS
K, E, A = 6, 4, 3  # modes of identity, expression, albedo


class Face:
    """Half an ellipsoid with the landmarks of a face, in mm; random modes of plausible sizes."""

    def __init__(self, seed=0):
        rng = np.random.default_rng(seed)
        v, u = (axis.ravel() for axis in np.meshgrid(*(np.linspace(-1, 1, k) for k in (ROWS, COLUMNS)), indexing="ij"))
        longitude, latitude = 1.35 * u, 1.2 * v
        self.mean = np.column_stack(
            [
                75 * np.cos(latitude) * np.sin(longitude),
                110 * np.sin(latitude) - 30,
                90 * np.cos(latitude) * np.cos(longitude),
            ]
        )
        self.mean += rng.normal(0, 0.2, self.mean.shape)
        a = (np.arange(ROWS - 1)[:, None] * COLUMNS + np.arange(COLUMNS - 1)).ravel()
        self.quads = np.column_stack([a, a + 1, a + COLUMNS + 1, a + COLUMNS])
        self.faces = np.vstack([self.quads[:, [0, 1, 2]], self.quads[:, [0, 2, 3]]])  # outwards
        self.uv = np.column_stack([(u + 1) / 2, (v + 1) / 2])
        template = default_model()
        points = template.mean[template.landmarks]
        self.landmarks = np.array([((self.mean - p) ** 2 * [1, 1, 0.1]).sum(1).argmin() for p in points])
        self.identity = rng.normal(0, 2.0, (K, N, 3))
        self.expression = rng.normal(0, 1.0, (E, N, 3))
        self.colour = rng.uniform(0.2, 0.9, (N, 3))
        self.albedo = rng.normal(0, 0.05, (A, N, 3))
        self.deviations = np.array([9.0, 7, 5, 4, 3, 2])
        self.rng = rng

    @property
    def origin(self):
        """Midway between the eyes, 13 mm behind the middle of their corners."""
        return self.mean[self.landmarks[[36, 39, 42, 45]]].mean(0) - [0, 0, 13]


def _columns(modes):
    return modes.reshape(len(modes), -1).T


def _mat(variables, compressed=False):
    import scipy.io

    stream = io.BytesIO()
    scipy.io.savemat(stream, variables, do_compression=compressed)
    return stream.getvalue()


def _npz(**arrays):
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def bfm2009(face, path):
    """01_MorphableModel.mat: micrometres, EV are standard deviations, triangles from 1 that face into the head."""
    ev = face.deviations[:, None] * 1000
    variables = {
        "shapeMU": 1000 * face.mean.reshape(-1, 1), "shapePC": _columns(face.identity / face.deviations[:, None, None]),
        "shapeEV": ev, "texMU": 255 * face.colour.reshape(-1, 1), "texPC": _columns(face.albedo),
        "texEV": np.full((A, 1), 255.0), "tl": face.faces[:, ::-1] + 1.0, "segbin": np.ones((N, 4)),
    }  # fmt: skip
    arrays = {k: np.asarray(v, np.float32 if "PC" in k else float) for k, v in variables.items()}
    path.write_bytes(_mat(arrays, compressed=True))
    return path


def face3d(face, path):
    """face3d's BFM.mat: a struct of the same, with expressions, landmarks and the mouth; triangles as columns."""
    model = {
        "shapeMU": 1000 * (face.mean - 1.0).reshape(-1, 1), "shapePC": _columns(face.identity),
        "expMU": np.full((3 * N, 1), 1000.0), "shapeEV": np.full((K, 1), 1000.0),
        "expPC": _columns(face.expression), "expEV": np.full((E, 1), 1000.0),
        "texMU": 255 * face.colour.reshape(-1, 1), "texPC": _columns(face.albedo), "texEV": np.full((A, 1), 255.0),
        "tri": (face.faces[10:, ::-1] + 1).T.astype(np.int32),
        "tri_mouth": (face.faces[:10, ::-1] + 1).T.astype(np.int32),
        "kpt_ind": (face.landmarks + 1)[None].astype(np.int32),
    }  # fmt: skip
    path.write_bytes(_mat({"model": model}))
    return path


def deep3d(face, path):
    """Deep3D's BFM_model_front.mat: decimetres, bases times their deviations, colours 0..255."""
    path.write_bytes(
        _mat(
            {
                "meanshape": face.mean.reshape(1, -1) / 100, "idBase": _columns(face.identity) / 100,
                "exBase": _columns(face.expression) / 100, "meantex": 255 * face.colour.reshape(1, -1),
                "texBase": 255 * _columns(face.albedo), "tri": face.faces + 1.0,
                "keypoints": face.landmarks[None] + 1.0, "point_buf": np.ones((N, 8)),
            }
        )
    )  # fmt: skip
    return path


def bfm2017(face, path):
    """model2017-1_*.h5: mm, orthonormal columns and variances, cells (3, m)."""
    import h5py

    lengths = np.linalg.norm(face.identity.reshape(K, -1), axis=1)
    with h5py.File(path, "w") as file:
        for kind, mean, modes in (
            ("shape", face.mean, face.identity), ("expression", np.zeros((N, 3)), face.expression),
            ("color", face.colour, face.albedo),
        ):  # fmt: skip
            lengths = np.linalg.norm(modes.reshape(len(modes), -1), axis=1)
            file[f"{kind}/model/mean"] = mean.ravel().astype(np.float32)
            file[f"{kind}/model/pcaBasis"] = (_columns(modes) / lengths).astype(np.float32)
            file[f"{kind}/model/pcaVariance"] = (lengths**2).astype(np.float32)
            file[f"{kind}/model/noiseVariance"] = np.zeros(1, np.float32)
        file["shape/representer/cells"] = face.faces.T.astype(np.int32)
        file["shape/representer/points"] = face.mean.T.astype(np.float32)
        corners = zip(("right", "right", "left", "left"), ("outer", "inner", "inner", "outer"), strict=True)
        points = face.mean[face.landmarks[[36, 39, 42, 45]]]
        file["metadata/landmarks/json"] = json.dumps(
            [
                {"id": f"{side}.eye.corner_{end}", "coordinates": p.tolist()}
                for (side, end), p in zip(corners, points, strict=True)
            ]
        )
    return path


def flame_arrays(face):
    rng = face.rng
    shapes = np.zeros((N, 3, 304))
    shapes[:, :, :K] = np.moveaxis(face.identity, 0, 2)
    shapes[:, :, 300:] = np.moveaxis(face.expression, 0, 2)
    regressor = rng.uniform(0, 1, (5, N)) * (rng.uniform(0, 1, (5, N)) < 0.05)
    weights = rng.uniform(0, 1, (N, 5))
    return {
        "v_template": face.mean / 1000, "f": face.faces.astype(np.uint32), "shapedirs": shapes / 1000,
        "posedirs": rng.normal(0, 1e-4, (N, 3, 36)), "J_regressor": regressor / regressor.sum(1, keepdims=True),
        "kintree_table": np.array([[2**32 - 1, 0, 1, 1, 1], [0, 1, 2, 3, 4]], np.int64),
        "weights": weights / weights.sum(1, keepdims=True), "bs_style": "lbs", "bs_type": "lrotmin",
    }  # fmt: skip


def flame_pickle(face, path):
    """generic_model.pkl: arrays of numpy, variables of chumpy, a sparse matrix; written by Python 2's protocol."""
    import scipy.sparse as sp

    arrays = flame_arrays(face)
    chumpy, ch = types.ModuleType("chumpy"), types.ModuleType("chumpy.ch")
    ch.Ch = type("Ch", (), {"__module__": "chumpy.ch"})
    names = {"chumpy": chumpy, "chumpy.ch": ch}
    sys.modules.update(names)
    try:
        for name in ("v_template", "shapedirs", "posedirs"):
            variable = ch.Ch()
            variable.__dict__ = {"x": arrays[name], "_dirty_vars": set()}
            del variable.__dict__["_dirty_vars"]
            arrays[name] = variable
        arrays["J_regressor"] = sp.csc_matrix(arrays["J_regressor"])
        path.write_bytes(pickle.dumps(arrays, protocol=2))
    finally:
        for name in names:
            del sys.modules[name]
    return path


def flame_archive(face, path):
    arrays = {k: v for k, v in flame_arrays(face).items() if isinstance(v, np.ndarray)}
    path.write_bytes(_npz(**arrays))
    return path


def gnm(face, path):
    """gnm_head.npz: metres, quads, texture coordinates a corner, groups."""
    groups = np.zeros((2, N), np.float32)
    groups[0, :40] = groups[1, 40:] = 1
    path.write_bytes(
        _npz(
            template_vertex_positions=face.mean / 1000, vertex_identity_basis=(face.identity / 1000).astype(np.float32),
            expression_basis=(face.expression / 1000).astype(np.float32), triangles=face.faces.astype(np.int32),
            quads=face.quads.astype(np.int32), triangle_uvs=face.uv[face.faces].astype(np.float32),
            expression_names=np.array([f"lower_face_region_{k}" for k in range(E)]),
            identity_names=np.array([f"head_{k}" for k in range(K)]), vertex_groups=groups,
            vertex_group_names=np.array(["tongue", "skin"]), mirror_indices=np.arange(N)[::-1].astype(np.int32),
        )
    )  # fmt: skip
    return path


def gnm_landmarks(face, path):
    indices = np.repeat(face.landmarks[:, None], 3, 1).astype(np.int32)
    path.write_bytes(_npz(indices=indices, weights=np.tile(np.float32([0.5, 0.25, 0.25]), (68, 1))))
    return path


def facescape(face, path):
    """facescape_bm_v1.6_*.npz: core (3 n, expressions, people), indices from 1, dictionaries as pickles."""
    core = np.zeros((3 * N, E + 1, K + 1), np.float32)
    neutral = np.concatenate([face.mean.reshape(1, -1) / -0.034, face.identity.reshape(K, -1) / 0.034]).T
    core[:] = neutral[:, None]
    core[:, 1:, 0] += _columns(face.expression) / -0.034
    path.write_bytes(
        _npz(
            shape_bm_core=core, fv_indices=(face.faces + 1).astype(np.int32),
            ft_indices=(face.faces + 1).astype(np.int32), texcoords=face.uv,
            lm_list_v16=face.landmarks, id_mean=np.r_[-0.034, np.zeros(K)],
            id_var=np.r_[0.0, np.full(K, 0.034**2)], sym_dict=np.array({1: 2}, object),
        )
    )  # fmt: skip
    return path


def people(face, count=8):
    coefficients = face.rng.standard_normal((count, K))
    coefficients -= coefficients.mean(0)
    neutral = face.mean + np.tensordot(coefficients, face.identity, 1)
    return np.stack([neutral, *(neutral + shape for shape in face.expression)], 1)  # (people, expressions, n, 3)


def facewarehouse_tensor(face, path):
    path.write_bytes(
        _npz(tensor=people(face) / 1000, faces=face.faces, landmarks=face.landmarks, uv=face.uv, uv_faces=face.faces)
    )
    return path


def obj_text(vertices, face):
    lines = ["v {:.6f} {:.6f} {:.6f}".format(*v) for v in vertices]
    lines += ["vt {:.6f} {:.6f}".format(*v) for v in face.uv]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}" for i in quad) for quad in face.quads]
    return "\n".join(lines) + "\n"


def facewarehouse_folder(face, folder):
    """Tester_k/Blendshape/shape.bs: three counts and float32, the neutral first."""
    for k, shapes in enumerate(people(face, 3)):
        person = folder / f"Tester_{k + 1}"
        (person / "Blendshape").mkdir(parents=True)
        (person / "TrainingPose").mkdir()
        head = struct.pack("<3i", E, N, len(face.quads))
        (person / "Blendshape" / "shape.bs").write_bytes(head + (shapes / 100).astype("<f4").tobytes())
    (folder / "Tester_1" / "TrainingPose" / "pose_0.obj").write_text(obj_text(face.mean / 100, face))
    return folder


def eos(face, path):
    """cereal: version, mean, basis, eigenvalues, triangles, an empty colour model, texture coordinates."""

    def matrix(a):
        a = np.asarray(a, "<f4")
        return struct.pack("<2i", *a.shape) + np.asfortranarray(a).tobytes("F")

    lengths = np.linalg.norm(face.identity.reshape(K, -1), axis=1)
    empty = matrix(np.zeros((0, 0))) * 3 + struct.pack("<Q", 0)
    path.write_bytes(
        struct.pack("<I", 1) + matrix(face.mean.reshape(-1, 1)) + matrix(_columns(face.identity) / lengths)
        + matrix(lengths[:, None] ** 2) + struct.pack("<Q", len(face.faces)) + face.faces.astype("<i4").tobytes()
        + empty + struct.pack("<Q", N) + (face.uv * [1, -1] + [0, 1]).astype("<f8").tobytes()
    )  # fmt: skip
    shapes = struct.pack("<Q", E)
    for k, shape in enumerate(face.expression):
        name = f"shape{k}".encode()
        shapes += struct.pack("<Q", len(name)) + name + matrix(shape.reshape(-1, 1))
    path.with_name("expression_blendshapes_550.bin").write_bytes(shapes)
    rows = [f"{k + 1} = {face.landmarks[k]}" for k in (8, *range(17, 68))]
    path.with_name("ibug_to_sfm.txt").write_text("[landmark_mappings]\n" + "\n".join(rows) + "\n[contour_landmarks]\n")
    contour = {"model_contour": {"right_contour": [3, 4], "left_contour": [5, 6]}}
    path.with_name("sfm_model_contours.json").write_text(json.dumps(contour))
    return path


FILES = {
    "bfm2009": (bfm2009, "01_MorphableModel.mat"),
    "face3d": (face3d, "BFM.mat"),
    "deep3d": (deep3d, "BFM_model_front.mat"),
    "bfm2017": (bfm2017, "model2017-1_bfm_nomouth.h5"),
    "flame_pickle": (flame_pickle, "generic_model.pkl"),
    "flame_archive": (flame_archive, "flame.npz"),
    "gnm": (gnm, "gnm_head.npz"),
    "facescape": (facescape, "facescape_bm_v1.6_847_50_52_id_front.npz"),
    "facewarehouse": (facewarehouse_tensor, "facewarehouse.npz"),
    "eos": (eos, "sfm_shape_550.bin"),
}
