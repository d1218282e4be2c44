"""An avatar back from its file."""

import os

import numpy as np

from toongeo.avatar.avatar import Avatar
from toongeo.avatar.field_types import check_field_types
from toongeo.avatar.scene import head_parts
from toongeo.avatar.state import decode_state
from toongeo.io import Scene, SceneMesh, glb_scene, read_glb, split_seams
from toongeo.model import MorphableModel, atlas_coordinates, default_model
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.pipeline import Hair
from toongeo.reading.promise import promised

__all__ = ["load_avatar"]


@promised("a GLB that Avatar.save wrote")
def load_avatar(path: str | os.PathLike[str], *, model: MorphableModel | None = None) -> Avatar:
    """Read a ``.glb`` that :meth:`toongeo.Avatar.save` wrote.

    Every field of the avatar comes back: to float32 from a plain file (lengths to 1e-6 of the size of the head), the
    texture exactly; only the seconds of the reports are 0. A quantized file gives expressions that are off by less
    than 0.1 mm and the confidence of the parse in 63 steps, one with ``texture="jpeg"`` the pixels of the JPEG, one
    with ``texture=None`` a texture of one colour.

    Parameters
    ----------
    path
        File with its suffix.
    model : MorphableModel, optional
        The model with which the avatar was made, if it is not :func:`toongeo.default_model`; files hold no models.

    Returns
    -------
    Avatar

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it is no GLB, damaged, changed by another program or by a byte, saved without what is needed
        (``loadable=False``, another crop or names), or made with another model.

    Examples
    --------
    ``avatar = toongeo.load_avatar("face.glb")``; and of another file:

    >>> from pathlib import Path
    >>> size = Path("other.glb").write_bytes(b"nothing of the kind")
    >>> load_avatar("other.glb")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    ValueError: path: expected a GLB (glTF 2.0), but ... is damaged or none (...)
    """
    document = read_glb(path)
    if document.attachment is None:
        raise ValueError(f"path: expected a GLB that Avatar.save wrote with loadable=True, got {path}")
    if not document.intact:
        raise ValueError(f"path: {path} is damaged, or another program has changed it")
    model = default_model() if model is None else model
    scene = glb_scene(document)
    try:
        known = _rig_arrays(scene, model)
        state = decode_state(document.attachment, known, model)
        hair = _hair(scene, state.pop("hair", None))
        avatar = Avatar(**state, texture=_texture(scene.meshes[0]), hair=hair)
        check_field_types(avatar)
        _check_shapes(avatar, model)
        return avatar
    except (LookupError, TypeError, AttributeError, ArithmeticError, RecursionError, ValueError) as error:
        raise ValueError(f"path: {path} cannot be loaded: {error}") from error


def _check_shapes(avatar: Avatar, model: MorphableModel) -> None:
    """Refuse arrays that do not fit the model, whoever wrote them."""
    n, k, e = len(model.mean), len(model.identity), len(avatar.rig.names)
    face, fit, eyes = avatar.face, avatar.fit, avatar.eyes
    balls = len(eyes.templates)
    for name, array, shape in (
        ("face.vertices", face.vertices, (n, 3)),
        ("face.landmark_vertices", face.landmark_vertices, (68,)),
        ("fit.landmark_vertices", fit.landmark_vertices, (68,)),
        ("fit.identity", fit.identity, (k,)),
        ("fit.expression", fit.expression, (len(model.expression),)),
        ("rig.pose", avatar.rig.pose, (e,)),
        ("eyes.centres", eyes.centres, (balls, 3)),
        ("eyes.radii", eyes.radii, (balls,)),
        ("eyes.turn", eyes.turn, (balls, 2)),
    ):
        if array.shape != shape or not np.isfinite(array).all():
            raise ValueError(f"{name}: expected finite numbers of shape {shape}, got {array.dtype} {array.shape}")
        if name.endswith("landmark_vertices") and not (
            array.dtype.kind in "iu" and 0 <= array.min() <= array.max() < n
        ):
            raise ValueError(f"{name}: expected vertices in 0..{n - 1}")


def _rig_arrays(scene: Scene, model: MorphableModel) -> dict[str, np.ndarray]:
    """Neutral vertices (n, 3), deltas (k, n, 3) and gaze (8, n, 3) from the meshes of the head."""
    meshes = {mesh.name: mesh for mesh in scene.meshes}
    parts = head_parts(model)
    names = meshes["head"].target_names
    neutral = np.zeros(model.mean.shape)
    shapes = np.zeros((len(names), *neutral.shape), np.float32)
    for part, rows in parts.items():
        mesh, vertex = meshes[part], _file_vertices(meshes[part], part, rows, model)
        neutral[vertex] = mesh.vertices
        for name, delta in zip(mesh.target_names, () if mesh.targets is None else mesh.targets, strict=True):
            with np.errstate(over="ignore"):
                shapes[names.index(name), vertex] = delta
    if not np.isfinite(shapes).all():
        raise ValueError("a displacement is beyond float32")
    return {"neutral": neutral, "deltas": shapes[: -len(GAZE_NAMES)], "gaze": shapes[-len(GAZE_NAMES) :]}


def _file_vertices(mesh: SceneMesh, part: str, rows: np.ndarray, model: MorphableModel) -> np.ndarray:
    """Vertex of the model that each vertex of a mesh in the file is."""
    used, faces = np.unique(model.faces[rows], return_inverse=True)
    _, uv_faces = np.unique(atlas_coordinates(model).uv_faces[rows], return_inverse=True)
    vertex, _, split = split_seams(faces.reshape(-1, 3), uv_faces.reshape(-1, 3))
    if len(vertex) != len(mesh.vertices) or not np.array_equal(split, mesh.faces):
        got = f"{len(mesh.vertices)} vertices of {len(vertex)} in {part!r}"
        raise ValueError(f"model: expected the model with which the avatar was made, got another ({got})")
    return used[vertex]


def _hair(scene: Scene, seams: np.ndarray | None) -> Hair | None:
    """The hair, whose vertex and uv each point of its mesh is (2, p); None if there is none."""
    if seams is None:
        return None
    (mesh,) = (mesh for mesh in scene.meshes if mesh.name == "hair")
    vertex, uv = seams.astype(np.int64)
    vertices, coordinates = np.zeros((vertex.max() + 1, 3)), np.zeros((uv.max() + 1, 2))
    vertices[vertex], coordinates[uv] = mesh.vertices, mesh.uv
    return Hair(vertices, vertex[mesh.faces], coordinates, uv[mesh.faces], _texture(mesh))


def _texture(mesh: SceneMesh) -> np.ndarray:
    if mesh.texture is not None:
        return mesh.texture
    return np.full((8, 8, 3), np.rint(255 * np.array(mesh.color)), np.uint8)
