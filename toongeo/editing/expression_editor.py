"""The expression of a picture, edited again and again."""

import dataclasses
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from toongeo.avatar.avatar import Avatar, Weights
from toongeo.avatar.make_avatar import make_avatar
from toongeo.editing.compose_texture import compose_texture
from toongeo.editing.texture.new_skin import NewSkin
from toongeo.editing.texture.picture_mesh import picture_mesh
from toongeo.editing.texture.picture_warp import picture_warp
from toongeo.editing.texture_generator import ClassicalTextureGenerator
from toongeo.io import check_image
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.anatomy.lid_rings import lids_of
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline import AlignedFace, FaceFit, Rig, build_rig, fit_lids, fit_mouth
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.rig.weight_vector import weight_vector
from toongeo.protocols import TextureGenerator, TextureGeometry

__all__ = ["ExpressionEditor"]

_NEEDS = ("eyes", "uv", "mouth_cavity", "lips", "eyeBlinkLeft", "eyeBlinkRight", *lids_of("left"), *lids_of("right"))
_TEXTURE_SIZE = 512  # texels
_ROUNDS = 3  # of taking out a known expression; six of the seven examples agree by then (benchmarks/editing.py)


class ExpressionEditor:
    """A picture of a face, prepared so that its expression can be changed many times a second.

    The face is fitted once. For each frame the mesh is deformed, its texture is made to suit (Chen et al. 2020, Eq.
    12), and it is drawn over the picture with the camera that was found. What the picture shows is taken from the
    picture itself, so that nothing of it is lost; the rest - teeth, tongue, closed lids, hidden parts of the eyes -
    from the texture. The neighbourhood moves along and comes to rest a little farther out, where nothing is touched;
    hair and ears stay.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    avatar : Avatar, optional
        Of this picture, if it has been made already.
    generator : TextureGenerator, optional
        :class:`ClassicalTextureGenerator` unless another is given. Where lids close and lips part the picture gives
        way to the texture, and lashes are drawn, whoever made it.
    pose : mapping of name to weight, or (46,) array, optional
        The expression that the picture shows, where it is known; ``avatar.rig.pose`` if None.
    scheme : str or table
        What the landmarks are: see :func:`toongeo.make_avatar`.

    Raises
    ------
    ValueError
        For pictures and landmarks as :func:`toongeo.make_avatar`; for ``pose`` as :meth:`frame`; if the avatar's model
        has no eyeballs, lids, blinks, lips, inside of the mouth or texture coordinates.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> avatar = tg.make_avatar(img, landmarks, hair=False)
    >>> editor = tg.ExpressionEditor(img, landmarks, avatar=avatar)
    >>> smile = editor.frame({"mouthSmileLeft": 0.8, "mouthSmileRight": 0.8})
    >>> smile.shape == img.shape, bool((smile != img).any()), bool((smile == img)[0].all())
    (True, True, True)
    """

    def __init__(
        self,
        img: np.ndarray,
        landmarks: np.ndarray,
        *,
        avatar: Avatar | None = None,
        generator: TextureGenerator | None = None,
        pose: Mapping[str, float] | np.ndarray | None = None,
        scheme: Any = "ibug68",
    ) -> None:
        check_image(img)
        self.avatar = avatar or make_avatar(img, landmarks, texture_size=_TEXTURE_SIZE, scheme=scheme)
        face, rig = self.avatar.face, self.avatar.rig
        if pose is not None:
            rig = _rig_at_rest(face, rig, weight_vector(pose, rig.names))
        if not face.model.has(*_NEEDS):
            raise ValueError(f"avatar: expected one whose model has {', '.join(_NEEDS)}, got one without")
        self._rig, self._img, self._checksum = rig, img, _checksum(img)
        self.pose = np.r_[rig.pose if pose is None else weight_vector(pose, rig.names), self.avatar.eyes.pose]
        self._generator = generator or ClassicalTextureGenerator(face.model, rig, self.avatar.texture)
        self._new_skin = NewSkin(face.model, rig, self.avatar.texture)
        self._mesh = picture_mesh(face, self.avatar.eyes)
        points = face.project(face.vertices[face.landmark_vertices])
        if isinstance(scheme, str) and face.report.noise is None:
            given = ibug_landmarks(landmarks, scheme)
            points = np.where(np.isfinite(given), given, points)
        self._warp = picture_warp(img, points, self._mesh, self.avatar.parse)

    @property
    def region(self) -> np.ndarray:
        """Pixels (H, W) bool that an expression may touch; all others of a frame are those of the picture."""
        region = np.zeros(self._img.shape[:2], bool)
        region[self._warp.box] = self._warp.freedom > 0
        return region

    def added(self, change: Weights) -> np.ndarray:
        """Weights (46 + 8,) of an expression that is the picture's and a change of it, each kept in [0, 1].

        Where the picture shows more of one than 1, or less than 0, what it shows is the limit.

        Parameters
        ----------
        change : mapping of name to weight, (46,) array or (54,) array
            Added to `pose`. Names that are left out are as in the picture, and with 0 everywhere so is the frame.

        Raises
        ------
        ValueError
            As :meth:`frame`.
        """
        wanted = self.pose + self.avatar.rig.weights(change)
        return np.clip(wanted, np.minimum(self.pose, 0.0), np.maximum(self.pose, 1.0))

    def weights(self, weights: Weights | FaceFit) -> np.ndarray:
        """Checked weights (46 + 8,): those of :meth:`frame`, with the picture's gaze unless another is named.

        Raises
        ------
        ValueError
            As :meth:`frame`.
        """
        rig = self.avatar.rig
        if isinstance(weights, FaceFit):
            weights = {name: w for name, w in weights.expression_weights().items() if name in rig.names}
        beta = rig.weights(weights)
        named = isinstance(weights, Mapping) and any(name in GAZE_NAMES for name in weights)
        if not named and not (isinstance(weights, np.ndarray) and weights.shape == beta.shape):
            beta[len(rig.names) :] = self.pose[len(rig.names) :]
        return beta

    def vertices(self, weights: Weights | FaceFit) -> np.ndarray:
        """Vertices (n, 3), mm, of the head in an expression: the picture's face, moved by the difference of weights."""
        rig = self._rig
        return self.avatar.face.vertices + (rig.vertices(self.weights(weights) - self.pose) - rig.neutral)

    def landmarks(self, weights: Weights | FaceFit) -> np.ndarray:
        """Landmarks (68, 2), px, of the edited picture."""
        face = self.avatar.face
        return face.project(self.vertices(weights)[face.landmark_vertices])

    def frame(self, weights: Weights | FaceFit) -> np.ndarray:
        """The picture with another expression.

        Parameters
        ----------
        weights : mapping of name to weight, (46,) array, (54,) array, or FaceFit
            The expression of the result, not a change of the picture's: names that are left out are 0. The gaze of
            the picture is kept unless ``eyeLook*`` names are among them. A fit lends its expression.

        Returns
        -------
        (H, W, 3) uint8 RGB
            Pixels outside :attr:`region` are those of the picture.

        Raises
        ------
        ValueError
            If a name is unknown (the nearest are suggested), an array has another length, a weight is not finite, or
            the picture has been changed since the editor was made.
        """
        if _checksum(self._img) != self._checksum:
            raise ValueError("img: expected the picture that was fitted, got one that has been changed since")
        face, model, texture = self.avatar.face, self.avatar.face.model, self.avatar.texture
        beta = self.weights(weights)
        V = self.vertices(beta)
        geometry = TextureGeometry(face.vertices, V, model.faces, model.uv, model.uv_faces)
        colour, attention = self._generator(texture, self.pose, beta, geometry)
        new = compose_texture(texture, colour, attention)  # Eq. 12
        gaze = dict(zip(GAZE_NAMES, beta[len(self.avatar.rig.names) :].tolist(), strict=True))
        moved = np.concatenate([V, *(self.avatar.eyes.looking(side, gaze) for side in range(len(SIDES)))])
        renewed = np.zeros(len(moved), np.float32)
        renewed[: len(V)] = self._new_skin.renewed(geometry)
        out = self._img.copy()
        drawn = self._warp.redrawn(moved, new, new - texture, renewed)
        drawn = self._warp.stroked(drawn, moved, self._new_skin.lash_strokes(geometry))
        drawn = np.where(self._warp.freedom[..., None] > 0, drawn, self._warp.picture)
        out[self._warp.box] = np.clip(np.rint(drawn), 0, 255).astype(np.uint8)
        return out


def _rig_at_rest(face: AlignedFace, rig: Rig, pose: np.ndarray) -> Rig:
    """Blendshapes of the face without its known expression: those built on a smile would be another's at rest.

    What is taken out depends on the blendshapes of the face at rest, and the other way round: a few rounds agree.
    """
    if np.array_equal(pose, rig.pose):
        return rig
    rest = face
    for _ in range(_ROUNDS):
        shown = np.tensordot(pose, build_rig(rest).deltas, 1)
        rest = dataclasses.replace(face, vertices=face.vertices - shown)
    rig, _ = fit_lids(rest, fit_mouth(rest, build_rig(rest)))
    return rig


def _checksum(img: np.ndarray) -> int:
    return zlib.crc32(img.tobytes())
