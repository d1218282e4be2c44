"""What the mesh writers are given: meshes in the model frame, their textures, their targets, an animation."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr
from toongeo.io.gltf.spring_chains import SpringChains

__all__ = ["METRES", "Scene", "SceneAnimation", "SceneMesh"]

METRES = 1e-3  # the unit of glTF and USD in ours; their axes (+Y up, a face looks along +Z) are ours already


@dataclass(frozen=True, eq=False)
class SceneMesh:
    """A textured triangle mesh with morph targets.

    Parameters
    ----------
    name
        Unique in its scene.
    vertices
        (n, 3) mm, model frame (+X subject's left, +Y up, +Z out of the face).
    faces
        (m, 3) counter-clockwise from outside.
    uv
        (t, 2), origin bottom-left, v up; None: untextured.
    uv_faces
        (m, 3) into ``uv``; None: ``faces``, one uv a vertex.
    normals
        (n, 3) of unit length; None: area-weighted means of the faces'.
    texture
        (H, W, 3) uint8 sRGB; the same array in several meshes is stored once.
    color
        sRGB, 0..1, of a mesh without texture (multiplies the texture if there is one).
    roughness
        0..1 of the glTF material.
    specular
        0..1: how strongly it mirrors, of what glass does.
    unlit
        Whether its colours are shown as they are, in files that can say so.
    targets
        (k, n, 3) mm: what each target at weight 1 adds to the vertices.
    target_names
        k names, each once.
    pivot
        (3,) mm, model frame: about which the mesh turns (the centre of an eyeball). The writer makes the
        vertices local to it; here they stay in the model frame.
    double_sided
        Whether the inner side of its faces is drawn, too.
    parent
        Name of a mesh of the scene on which this one sits, and which takes it along.
    springs
        Chains of bones on which parts of it swing, in files that know them (VRM).

    Raises
    ------
    ValueError
        If shapes, indices or names do not fit; names the mesh and the field.
    """

    name: str
    vertices: NDArray[np.floating]
    faces: NDArray[np.integer]
    uv: NDArray[np.floating] | None = None
    uv_faces: NDArray[np.integer] | None = None
    normals: NDArray[np.floating] | None = None
    texture: NDArray[np.uint8] | None = None
    color: tuple[float, float, float] = (1.0, 1.0, 1.0)
    roughness: float = 0.9
    specular: float = 1.0
    unlit: bool = False
    targets: NDArray[np.floating] | None = None
    target_names: tuple[str, ...] = ()
    pivot: NDArray[np.floating] | None = None
    double_sided: bool = False
    parent: str | None = None
    springs: SpringChains | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise ValueError(f"name: expected a name for the mesh, got {self.name!r}")
        n, m = len(self.vertices), len(self.faces)
        self._put("vertices", _finite(self._label("vertices"), self.vertices, (n, 3)))
        self._put("faces", _indices(self._label("faces"), self.faces, (m, 3), n))
        self._check_uv(m)
        self._check_look()
        self._check_targets(n)
        if self.normals is not None:
            normals = _finite(self._label("normals"), self.normals, (n, 3))
            if np.abs(np.linalg.norm(normals, axis=1) - 1).max(initial=0) > 1e-4:
                raise ValueError(f"{self._label('normals')}: expected vectors of unit length")
            self._put("normals", normals)
        if self.pivot is not None:
            self._put("pivot", _finite(self._label("pivot"), self.pivot, (3,)))
        if self.springs is not None and len(self.springs.weights) != n:
            raise ValueError(f"{self._label('springs')}: expected weights of {n}, got {len(self.springs.weights)}")

    def moved(self, weights: Mapping[str, float]) -> NDArray[np.floating]:
        """Vertices (n, 3), mm, with targets added; names the mesh does not have are ignored."""
        vertices = self.vertices
        if self.targets is not None:
            for name in (name for name in self.target_names if name in weights):
                vertices = vertices + weights[name] * self.targets[self.target_names.index(name)]
        return vertices

    def _check_uv(self, m: int) -> None:
        if self.uv is None:
            if self.uv_faces is not None or self.texture is not None:
                raise ValueError(f"{self._label('uv')}: expected (t, 2) for the uv_faces or texture, got None")
            return
        t = len(self.uv)
        uv_faces = self.faces if self.uv_faces is None else self.uv_faces
        self._put("uv", _finite(self._label("uv"), self.uv, (t, 2)))
        self._put("uv_faces", _indices(self._label("uv_faces"), uv_faces, (m, 3), t))

    def _check_look(self) -> None:
        if self.texture is not None:
            texture = np.asarray(self.texture)
            if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[2] != 3 or not texture.size:
                got = f"{texture.dtype} {texture.shape}"
                raise ValueError(f"{self._label('texture')}: expected (H, W, 3) uint8, got {got}")
            self._put("texture", texture)
        color = _finite(self._label("color"), self.color, (3,))
        for label, values in (
            ("color", color),
            *((name, np.asarray(getattr(self, name))) for name in ("roughness", "specular")),
        ):
            if not ((values >= 0) & (values <= 1)).all():
                raise ValueError(f"{self._label(label)}: expected 0..1, got {values}")
        object.__setattr__(self, "color", tuple(color.tolist()))

    def _check_targets(self, n: int) -> None:
        names = tuple(self.target_names)
        k = 0 if self.targets is None else len(self.targets)
        if len(names) != k or len(set(names)) != k:
            raise ValueError(f"{self._label('target_names')}: expected {k} different names, got {len(names)}")
        object.__setattr__(self, "target_names", names)
        if self.targets is not None:
            self._put("targets", _finite(self._label("targets"), self.targets, (k, n, 3)))

    def _label(self, attribute: str) -> str:
        return f"{attribute} of mesh {self.name!r}"

    def _put(self, attribute: str, array: NDArray) -> None:
        view = array.view()
        view.flags.writeable = False
        object.__setattr__(self, attribute, view)


@dataclass(frozen=True, eq=False)
class SceneAnimation:
    """Weights and rotations over time, linear in between.

    Parameters
    ----------
    times
        (f,) s, increasing, the first >= 0.
    weights
        Mesh name -> (f, k), a column a target.
    rotations
        Mesh name -> (f, 4) unit quaternions x, y, z, w about the mesh's pivot.
    turns
        (f, 4) unit quaternions by which all meshes turn together, about ``neck``.
    neck
        (3,) mm, model frame; needed for ``turns``.
    name
        Of the clip.
    """

    times: NDArray[np.floating]
    weights: Mapping[str, NDArray[np.floating]] = field(default_factory=dict)
    rotations: Mapping[str, NDArray[np.floating]] = field(default_factory=dict)
    name: str = "demo"
    turns: NDArray[np.floating] | None = None
    neck: NDArray[np.floating] | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        f = len(self.times)
        times = _finite("times", self.times, (f,))
        if f == 0 or times[0] < 0 or (np.diff(times) <= 0).any():
            raise ValueError("times: expected increasing seconds, the first >= 0")
        object.__setattr__(self, "times", times)
        weights = {mesh: _finite(f"weights of {mesh!r}", w, (f, None)) for mesh, w in self.weights.items()}
        rotations = {mesh: _finite(f"rotations of {mesh!r}", q, (f, 4)) for mesh, q in self.rotations.items()}
        for mesh, quaternions in rotations.items():
            _check_unit(f"rotations of {mesh!r}", quaternions)
        if (self.turns is None) != (self.neck is None):
            raise ValueError("turns, neck: expected both or neither")
        if self.turns is not None:
            turns = _finite("turns", self.turns, (f, 4))
            _check_unit("turns", turns)
            object.__setattr__(self, "turns", turns)
            object.__setattr__(self, "neck", _finite("neck", self.neck, (3,)))
        object.__setattr__(self, "weights", weights)
        object.__setattr__(self, "rotations", rotations)


@dataclass(frozen=True, eq=False)
class Scene:
    """Meshes, and an animation of them.

    Raises
    ------
    ValueError
        If there is no mesh, two have one name, or the animation does not fit them.
    """

    meshes: tuple[SceneMesh, ...]
    animation: SceneAnimation | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        object.__setattr__(self, "meshes", tuple(self.meshes))
        targets = {mesh.name: len(mesh.target_names) for mesh in self.meshes}
        if not targets or len(targets) != len(self.meshes):
            raise ValueError(f"meshes: expected at least one, of different names, got {list(targets)}")
        for mesh in self.meshes:
            above = next((m for m in self.meshes if m.name == mesh.parent), None)
            if mesh.parent is not None and (above is None or above.parent is not None or above.pivot is not None):
                label = f"parent of mesh {mesh.name!r}"
                raise ValueError(f"{label}: expected a mesh without parent and pivot, got {mesh.parent!r}")
        if self.animation is None:
            return
        for name in (*self.animation.weights, *self.animation.rotations):
            if name not in targets:
                raise ValueError(f"animation: expected names of meshes {list(targets)}, got {name!r}")
        for name, weights in self.animation.weights.items():
            if weights.shape[1] != targets[name] or not targets[name]:
                got = f"{weights.shape[1]} columns for {targets[name]} targets"
                raise ValueError(f"animation: weights of {name!r} have {got}")


def _check_unit(label: str, quaternions: NDArray[np.floating]) -> None:
    if np.abs(np.linalg.norm(quaternions, axis=1) - 1).max() > 1e-4:
        raise ValueError(f"{label}: expected quaternions of unit length")


def _finite(label: str, values: object, shape: tuple[int | None, ...]) -> NDArray[np.floating]:
    """Float array of this shape (None: any length); float32 stays float32."""
    array = np.asarray(values)
    array = array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)
    fits = array.ndim == len(shape) and all(s is None or s == a for s, a in zip(shape, array.shape, strict=True))
    if not fits:
        raise ValueError(f"{label}: expected shape {shape}, got {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{label}: expected finite numbers, got NaN or infinity")
    return array


def _indices(label: str, values: object, shape: tuple[int, int], count: int) -> NDArray[np.integer]:
    array = np.asarray(values)
    if array.shape != shape or array.dtype.kind not in "iu" or not array.size:
        raise ValueError(f"{label}: expected (m, 3) integers, m >= 1, got {array.dtype} {array.shape}")
    if array.min() < 0 or array.max() >= count:
        raise ValueError(f"{label}: expected indices in 0..{count - 1}, got {array.min()}..{array.max()}")
    return array.astype(np.int64, copy=False)
