"""A textured, rigged face."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._notebook_png import notebook_png
from toongeo.avatar.avatar_trimesh import avatar_trimesh
from toongeo.avatar.crop_faces import Crop
from toongeo.avatar.looks.neck_cap import neck_cap
from toongeo.avatar.looks.soft_light import soft_light
from toongeo.avatar.save_avatar import avatar_page, save_avatar
from toongeo.avatar.stages import AvatarStages
from toongeo.io.shown_page import ShownPage
from toongeo.model import atlas_coordinates
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.protocols import Camera
from toongeo.reading.check_file import file_name
from toongeo.render import (
    FrameRenderer,
    ScaledOrthographicCamera,
    Surface,
    render_mesh,
)
from toongeo.render.picture_size import picture_size

if TYPE_CHECKING:
    import trimesh

__all__ = ["Avatar", "Weights"]

_HEADROOM = 1.12  # of the head's height: how much of the world a picture shows
Weights = Mapping[str, float] | np.ndarray | None


@dataclass(frozen=True, eq=False)
class Avatar(AvatarStages):
    """What :func:`toongeo.make_avatar` builds; every stage's result is kept.

    Attributes
    ----------
    fit : FaceFit
    parse : FaceParse
    face : AlignedFace
    rig : Rig
        ``rig.names`` are the 46 expressions, ``rig.deltas`` (46, n, 3) mm their blendshapes.
    eyes : Eyes
    texture : (size, size, 3) uint8 RGB
    report : AvatarReport
    hair : Hair or None
        A mesh of its own, rigid on the head; None where hair is painted on the head, or there is none.
    style : Stylized or None
        The drawing of a photograph that the avatar was made of; None if it was made of the picture itself, or read
        from a file.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> avatar = tg.make_avatar(img, landmarks, hair=False)
    >>> avatar.vertices({"jawOpen": 0.6}).shape  # mm
    (19057, 3)
    >>> avatar.render({"eyeBlinkLeft": 1.0}, size=64).shape
    (64, 64, 3)
    >>> len(avatar.names), avatar.names[0]
    (46, 'browDownLeft')
    >>> avatar.fit.expression.shape, avatar.rig.deltas.shape, avatar.texture.shape  # what stages gave
    ((64,), (46, 19057, 3), (1024, 1024, 3))
    >>> avatar.save("face.glb")  # or .vrm, .usdz, .html, .obj, .ply
    """

    __repr__ = brief_repr
    _repr_png_ = notebook_png

    @property
    def names(self) -> tuple[str, ...]:
        """The 46 expressions of the rig. The eight ``eyeLook*`` names, which turn the eyes, are not among them."""
        return self.rig.names

    @property
    def pose(self) -> dict[str, float]:
        """The weights, without zeros, with which the avatar looks as in its picture.

        Expressions are those that open the mouth as it is drawn (``rig.pose``), ``eyeLook*`` the gaze (``eyes.pose``).
        ``avatar.render(avatar.pose)`` shows the picture's face, ``avatar.render()`` one at rest.
        """
        names, weights = (*self.names, *GAZE_NAMES), np.r_[self.rig.pose, self.eyes.pose]
        return {name: weight for name, weight in zip(names, weights.tolist(), strict=True) if weight != 0}

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
        count = len(self.eyes.templates)
        if side >= count:
            raise ValueError(f"side: expected an eyeball of the model, which has {count}, got {side}")
        gaze = self.rig.weights(weights)[len(self.names) :]
        return self.eyes.looking(side, dict(zip(GAZE_NAMES, gaze.tolist(), strict=True)))

    def surfaces(self, weights: Weights = None) -> list[Surface]:
        """Head, left and right eyeball, and hair if there is any, textured, for :func:`toongeo.render_mesh`."""
        model = self.face.model
        atlas = atlas_coordinates(model)
        head = Surface(self.vertices(weights), model.faces, uv=atlas.uv, uv_faces=atlas.uv_faces, texture=self.texture)
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
        hair = self.hair
        if hair is None:
            return [head, *eyes]
        worn = Surface(hair.vertices, hair.faces, uv=hair.uv, uv_faces=hair.uv_faces, texture=hair.texture)
        return [head, *eyes, worn]

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
        picture_size(size)
        camera = camera or self._camera(size, yaw, pitch)
        surfaces = self._closed(weights)
        if not textured:
            return render_mesh(surfaces, camera, size, shading="clay")
        # The texture holds the light of the picture already: a soft light shows the shape without shading it twice.
        return render_mesh(surfaces, camera, size, light=soft_light())

    def frame_renderer(self, size: int = 512, yaw: float = 0.0, pitch: float = 0.0) -> FrameRenderer:
        """What draws films as :meth:`render` does, faster: of :meth:`surfaces`, and of what closes the neck."""
        return FrameRenderer(self._closed(None), self._camera(size, yaw, pitch), size, light=soft_light())

    def to_trimesh(self, weights: Weights = None, *, crop: Crop = "head", textured: bool = True) -> trimesh.Scene:
        """Head, teeth, tongue and eyeballs with an expression, as ``trimesh.Trimesh`` objects.

        Parameters
        ----------
        weights
            As for :meth:`vertices`.
        crop : {"head", "bust", "face"}
            As for :meth:`save`.
        textured : bool
            True: with the texture, for which vertices on seams are repeated. False: vertices and triangles alone; those
            of a whole head without its parts are ``trimesh.Trimesh(avatar.vertices(), avatar.faces, process=False)``.

        Returns
        -------
        trimesh.Scene
            Geometries ``head``, ``teeth``, ``tongue``, ``eye_left``, ``eye_right`` and ``hair``, as far as they exist;
            mm, model frame.

        Raises
        ------
        ValueError
            For weights as :meth:`vertices`; for an unknown crop.
        """
        eyes = [self.eye_vertices(side, weights) for side in range(len(self.eyes.templates))]
        return avatar_trimesh(self, self.vertices(weights), eyes, crop=crop, textured=textured)

    def show(self, *, height: int = 520, title: str = "avatar", **options: Any) -> ShownPage:
        """The page of ``.html`` in a frame, as the last line of a notebook's cell; it asks nothing of a network.

        The notebook's file holds the whole page then, some megabytes; the avatar itself shows as a small picture. For
        weights that go to and fro see :class:`toongeo.AvatarWidget`.

        Parameters
        ----------
        height : int
            Of the frame, px.
        title : str
        **options
            ``crop quantize texture animation`` as of :meth:`save`.
        """
        return ShownPage(avatar_page(self, title, **options), height, title)

    def save(self, path: str | os.PathLike[str], *, format: str | None = None, **options: Any) -> None:
        """Write a file by its suffix, or what a format names.

        ================  ==================================================================================
        ``.glb``          options ``crop quantize normals texture animation names sparse loadable unlit``
        ``.vrm``          VRM 1.0 with a body of bones, hair below the chin swings; ``crop normals texture meta unlit``
        ``.html``         a page with sliders that needs no network; ``crop quantize texture animation title``
        ``.usdz``         with blend shapes, needs the extra ``usd``; ``crop names``
        ``.obj``          ``face.obj`` with ``face.mtl`` and ``face_texture.png`` beside it; ``crop``
        ``.ply``          with uv, and colours at the vertices; ``crop``
        ``obj-sequence``  a folder with an ``.obj`` an expression, ``face.mtl``, ``face_texture.png``; ``crop names``
        ================  ==================================================================================

        The file of this name is replaced. Those that come along with it, or stand in the folder, replace only what was
        written for the same output before.

        Parameters
        ----------
        path
            File to write, or folder.
        format : optional
            One of the names above, in place of the suffix.
        crop : {"head", "bust", "face"}
            "head" and "bust" are all that the template has; "face" is the front of the face with eyes and teeth.
        quantize : bool
            Displacements as integers: half the size, expressions off by less than 0.1 mm. A page does so by default.
        normals : bool
            Whether expressions bend the normals too: smoother shading in viewers that do not compute them, and a file
            half as big again.
        texture : {"png", "jpeg", None}
            None: each part in its mean colour.
        animation : "demo", None, or times (f,) in s, weights (f, 46) or (f, 54) and, if the head turns, unit
            quaternions (f, 4) x, y, z, w about the neck: ``toongeo.driving.head_quaternions``
        names : {"toongeo", "arkit", "talkinghead"}
            Of the targets: the rig's 46 and 8 directions of gaze; exactly the 52 of ARKit; or what players look for
            that speak by Oculus visemes, such as TalkingHead: those 52, 15 ``viseme_*``, ``mouthOpen``,
            ``mouthSmile``, ``eyesClosed``, ``eyesLookUp`` and ``eyesLookDown``, in meshes ``Wolf3D_Head``,
            ``Wolf3D_Teeth``, ... on the head of a body of 67 bones below a node ``Armature``.
        sparse : bool
            False: every target stores every vertex, for readers that know no sparse accessors.
        loadable : bool
            Whether :func:`toongeo.load_avatar` can read the file back. It then holds the fit and how the picture was
            parsed (some hundred kB). A file with another crop or other names never is.
        unlit : bool or "auto"
            Whether viewers show the colours as they are (``KHR_materials_unlit``, MToon in a ``.vrm``) or light them.
            "auto": drawings as they are, photographs and paintings lit. A ``.usdz`` is always lit: its material, a
            UsdPreviewSurface, knows nothing else.
        meta : toongeo.io.VrmMeta
            Name, authors and licence; by default nothing is allowed to others.
        title : str
            Of the page; by default the file's name without its suffix.

        Raises
        ------
        ValueError
            If the suffix or the format is unknown, or has no such option, or the option no such value; if a field of
            the avatar is of a kind that a loadable file cannot hold.
        ImportError
            If ``.usdz`` is asked for without the extra.
        FileExistsError
            If a file that comes along would replace one that was not written for this output.
        OSError
            If a file cannot be written; nothing half-written is left.
        """
        save_avatar(file_name(path), self, format, options)

    def _closed(self, weights: Weights) -> list[Surface]:
        """The surfaces, and what closes the neck."""
        cap = neck_cap(self.face.model, self.rig, self.texture)
        return self.surfaces(weights) + ([] if cap is None else [cap])

    def _camera(self, size: int, yaw: float, pitch: float) -> ScaledOrthographicCamera:
        skin = self.rig.neutral[self.face.region("skin")]
        shown = skin if self.hair is None else np.vstack([skin, self.hair.vertices])
        low, high = shown.min(0), shown.max(0)
        return ScaledOrthographicCamera.look(
            yaw, pitch, size=size, centre=(low + high) / 2, extent=_HEADROOM * (high - low).max()
        )
