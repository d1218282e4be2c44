"""A textured, rigged face."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from toongeo._read_only import read_only
from toongeo.avatar_report import AvatarReport
from toongeo.avatar_scene import avatar_scene
from toongeo.crop_faces import Crop
from toongeo.io import SceneMesh, write_glb, write_obj, write_ply
from toongeo.pipeline import AlignedFace, Eyes, FaceFit, Rig
from toongeo.pipeline.rig.gaze import GAZE_NAMES
from toongeo.protocols import Camera, FaceParse
from toongeo.render import (
    ScaledOrthographicCamera,
    Surface,
    irradiance,
    render_mesh,
    sample_image,
    studio_light,
    uv_to_px,
)

HEADROOM = 1.12  # of the head's height: how much of the world a picture shows
Weights = Mapping[str, float] | np.ndarray | None


@dataclass(frozen=True, eq=False)
class Avatar:
    """What :func:`toongeo.make_avatar` builds; every stage's result is kept.

    Attributes
    ----------
    fit : FaceFit
    parse : FaceParse
    face : AlignedFace
    rig : Rig
        ``rig.names`` are the 46 expressions, ``rig.deltas`` (46, n, 3) their blendshapes.
    eyes : Eyes
    texture : (size, size, 3) uint8 RGB
    report : AvatarReport
    """

    fit: FaceFit
    parse: FaceParse
    face: AlignedFace
    rig: Rig
    eyes: Eyes
    texture: np.ndarray
    report: AvatarReport

    def __post_init__(self) -> None:
        read_only(self, "texture")

    @property
    def names(self) -> tuple[str, ...]:
        """The 46 expressions of the rig. The eight ``eyeLook*`` names, which turn the eyes, are not among them."""
        return self.rig.names

    @property
    def faces(self) -> np.ndarray:
        """Triangles (m, 3) of the head; the eyeballs are meshes of their own."""
        return self.face.faces

    def vertices(self, weights: Weights = None) -> np.ndarray:
        """Vertices (n, 3) of the head, mm, model frame (Pan et al. 2024, Eq. 13).

        Parameters
        ----------
        weights : mapping of name to weight, (46,) array in the order of ``names``, (54,) array, or None
            1 is the full expression. ``eyeLook*`` names, the last eight of a (54,) array, turn the eyeballs and move
            the lids a little.

        Raises
        ------
        ValueError
            If a name is unknown (the nearest are suggested), an array has another length, or a weight is not finite.
        """
        return self.rig.vertices(weights)

    def eye_vertices(self, side: int, weights: Weights = None) -> np.ndarray:
        """Vertices (k, 3), mm, of the left (0) or right (1) eyeball; weights and errors as for :meth:`vertices`."""
        if side not in (0, 1):
            raise ValueError(f"side: expected 0 (left) or 1 (right), got {side!r}")
        gaze = self.rig.weights(weights)[len(self.names) :]
        return self.eyes.looking(side, dict(zip(GAZE_NAMES, gaze.tolist(), strict=True)))

    def surfaces(self, weights: Weights = None) -> list[Surface]:
        """Head, left and right eyeball, textured, for :func:`toongeo.render_mesh`."""
        model = self.face.model
        head = Surface(self.vertices(weights), model.faces, uv=model.uv, uv_faces=model.uv_faces, texture=self.texture)
        eyes = [
            Surface(
                self.eye_vertices(side, weights),
                eye.faces,
                uv=eye.uv,
                uv_faces=eye.faces,
                texture=self.texture,
            )
            for side, eye in enumerate(model.eyes)
        ]
        return [head, *eyes]

    def render(
        self,
        weights: Weights = None,
        size: int = 512,
        yaw: float = 0.0,
        pitch: float = 0.0,
        textured: bool = True,
        *,
        camera: Camera | None = None,
    ) -> np.ndarray:
        """Picture of the head.

        Parameters
        ----------
        weights
            As for :meth:`vertices`.
        size : int
            Side of the picture, px.
        yaw, pitch : float
            Degrees; yaw > 0 turns the face to the subject's left, pitch > 0 nods it down.
        textured : bool
            False shows plain clay.
        camera : Camera, optional
            Instead of a camera that frames the head; ``yaw`` and ``pitch`` are then not used.

        Returns
        -------
        (size, size, 3) uint8 RGB

        Raises
        ------
        ValueError
            For weights as :meth:`vertices`; if the size is not positive.
        """
        camera = camera or self._camera(size, yaw, pitch)
        surfaces = self.surfaces(weights)
        if not textured:
            return render_mesh(surfaces, camera, size, shading="clay")
        # The texture holds the light of the picture already: a soft light shows the shape without shading it twice.
        return render_mesh(surfaces, camera, size, light=_soft_light())

    def save(self, path: str | os.PathLike[str], *, crop: Crop = "head") -> None:
        """Write a file by its suffix: ``.glb``, ``.obj`` (with ``.mtl`` and ``.png`` beside it) or ``.ply``.

        Parameters
        ----------
        path
        crop : {"head", "bust", "face"}
            "head" and "bust" are all that the template has; "face" is the front of the face with eyes and teeth.

        Raises
        ------
        ValueError
            If the suffix is none of these, or the crop is unknown.
        OSError
            If the file cannot be written; nothing half-written is left.
        """
        path = Path(path)
        writer = WRITERS.get(path.suffix.lower())
        if writer is None:
            raise ValueError(f"path: expected a name that ends in {', '.join(WRITERS)}, got {path}")
        writer(path, self, crop)

    def _camera(self, size: int, yaw: float, pitch: float) -> ScaledOrthographicCamera:
        skin = self.rig.neutral[self.face.region("skin")]
        low, high = skin.min(0), skin.max(0)
        return ScaledOrthographicCamera.look(
            yaw, pitch, size=size, centre=(low + high) / 2, extent=HEADROOM * (high - low).max()
        )


def _soft_light() -> np.ndarray:
    """Half the relief of the studio light, and as bright towards the viewer."""
    light = studio_light()
    front = irradiance(np.array([[0.0, 0.0, 1.0]]), light)[0]
    light[1:] *= 0.5
    return light * (front / irradiance(np.array([[0.0, 0.0, 1.0]]), light)[0])


def _write_glb(path: Path, avatar: Avatar, crop: Crop) -> None:
    write_glb(path, avatar_scene(avatar.rig, avatar.eyes, avatar.face.model, avatar.texture, crop=crop))


def _write_obj(path: Path, avatar: Avatar, crop: Crop) -> None:
    write_obj(path, avatar_scene(avatar.rig, avatar.eyes, avatar.face.model, avatar.texture, crop=crop))


def _write_ply(path: Path, avatar: Avatar, crop: Crop) -> None:
    """Neutral head and eyeballs in one mesh, with the texture's colours at the vertices."""
    meshes = avatar_scene(avatar.rig, avatar.eyes, avatar.face.model, avatar.texture, crop=crop).meshes
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    write_ply(
        path,
        np.vstack([mesh.vertices for mesh in meshes]),
        np.vstack([mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=True)]),
        np.vstack([_vertex_colours(mesh) for mesh in meshes]),
    )


def _vertex_colours(mesh: SceneMesh) -> np.ndarray:
    """Colours (n, 3) uint8 that the texture has at the vertices."""
    assert mesh.texture is not None and mesh.uv is not None and mesh.uv_faces is not None
    corner = np.zeros(len(mesh.vertices), int)
    corner[mesh.faces.ravel()] = mesh.uv_faces.ravel()  # at a seam, any of the corners
    colours = sample_image(mesh.texture, uv_to_px(mesh.uv[corner], *mesh.texture.shape[:2]))
    return np.rint(colours).astype(np.uint8)


WRITERS: dict[str, Callable[[Path, Avatar, Crop], None]] = {
    ".glb": _write_glb,
    ".obj": _write_obj,
    ".ply": _write_ply,
}
