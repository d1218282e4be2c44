"""Places where another part, a learned one included, can be plugged in.

Each Protocol is satisfied by shape, not by inheritance: any object or function with these members fits.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Protocol

import numpy as np

__all__ = [
    "Camera",
    "Coefficients",
    "ExpressionDriver",
    "FaceLabel",
    "FaceParse",
    "FaceParser",
    "FittedFace",
    "HeadCamera",
    "LandmarkMapper",
    "Regressor",
    "TextureGenerator",
    "TextureGeometry",
]


class Camera(Protocol):
    """A map from the model frame (mm) to the image frame (pixels; x right, y down; integer = pixel centre)."""

    def project(self, points: np.ndarray) -> np.ndarray:
        """Pixels (k, 2) of model-frame points (k, 3)."""
        ...

    def depth(self, points: np.ndarray) -> np.ndarray:
        """Distance towards the viewer (k,) in mm; larger is nearer."""
        ...

    def view(self, points: np.ndarray) -> np.ndarray:
        """Camera-frame coordinates (k, 3) in mm: +X right, +Y up, +Z towards the viewer."""
        ...

    def unproject(self, pixels: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """Model-frame points (k, 3) whose pixels (k, 2) and depth (k,) are given; inverse of project and depth."""
        ...


class HeadCamera(Camera, Protocol):
    """A camera that sees a head and that a fit can follow."""

    @property
    def yaw(self) -> float:
        """Degrees; > 0 faces the subject's left."""
        ...

    @property
    def pitch(self) -> float:
        """Degrees; > 0 nods down."""
        ...

    @property
    def roll(self) -> float:
        """Degrees; > 0 is counter-clockwise in the image."""
        ...

    def cropped(self, corner: np.ndarray, factor: float) -> "HeadCamera":
        """Camera whose pixels are ``factor * (px - corner)``: of a picture that is cut, then resized."""
        ...

    def jacobian(self, points: np.ndarray) -> np.ndarray:
        """Derivative (k, 2, 3), px/mm, of the pixels by model-frame points (k, 3)."""
        ...


@dataclass(frozen=True, eq=False)
class Coefficients:
    """What describes a face in a picture; any part may be None, that is, not known.

    Attributes
    ----------
    identity : (k,) float
        Standard deviations.
    expression : (e,) float
        Named expressions in [0, 1], the others in standard deviations.
    albedo : (a,) float
        Standard deviations.
    light : float array
        Spherical harmonics a channel.
    pose : HeadCamera
        From the model frame to the picture.
    """

    identity: np.ndarray | None = None
    expression: np.ndarray | None = None
    albedo: np.ndarray | None = None
    light: np.ndarray | None = None
    pose: HeadCamera | None = None

    def __post_init__(self) -> None:
        for name in ("identity", "expression", "albedo", "light"):
            value = getattr(self, name)
            if value is None:
                continue
            array = np.array(value, np.float64)
            if not np.isfinite(array).all():
                raise ValueError(f"{name}: expected finite numbers or None, got NaN or infinity")
            array.setflags(write=False)
            object.__setattr__(self, name, array)


class Regressor(Protocol):
    """Guesses the coefficients of a face; a network, say, or any function."""

    def __call__(self, img: np.ndarray | None, landmarks: np.ndarray) -> Coefficients:
        """Coefficients of the face with landmarks (68, 2) px, NaN where missing.

        The picture is (H, W, 3) uint8, or None when there is none.
        """
        ...


@dataclass(frozen=True, eq=False)
class LandmarkDetection:
    """A face that was found in a picture.

    Attributes
    ----------
    points : (68, 2) float64 px
        iBUG-68 order; x right, y down, integer = pixel centre.
    confidence : (68,) float64 in [0, 1]
        The chance of each point to lie within 8 % of the outer-eye distance from its place.
    score : float in [0, 1]
        The chance that this is a face at all.
    """

    points: np.ndarray
    confidence: np.ndarray
    score: float

    def __post_init__(self) -> None:
        points, confidence = np.array(self.points, np.float64), np.array(self.confidence, np.float64)
        if points.shape != (68, 2) or not np.isfinite(points).all():
            raise ValueError(f"points: expected (68, 2) finite px, got {points.shape} or NaN or infinity")
        if confidence.shape != (68,) or not ((confidence >= 0) & (confidence <= 1)).all():
            raise ValueError(f"confidence: expected (68,) numbers in [0, 1], got {confidence.shape} or others")
        if not 0 <= self.score <= 1:
            raise ValueError(f"score: expected a number in [0, 1], got {self.score}")
        for name, array in (("points", points), ("confidence", confidence)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def box(self) -> np.ndarray:
        """(4,) px: left, top, right and bottom of the points."""
        return np.concatenate([self.points.min(axis=0), self.points.max(axis=0)])

    @property
    def is_sure(self) -> bool:
        """Whether this is likely a face whose points are mostly in their places; if not, a person should look.

        Of renders that nothing was trained on, one in twenty with good points has a mean confidence below 0.75.
        """
        return self.score >= 0.5 and float(self.confidence[17:].mean()) >= 0.75


class LandmarkDetector(Protocol):
    """Finds the faces of a picture and their landmarks; a network, say, or `detect_faces`."""

    def __call__(self, img: np.ndarray) -> list[LandmarkDetection]:
        """The faces of the picture (H, W, 3) uint8, the largest first."""
        ...


class FaceLabel(IntEnum):
    """What a pixel of a parsed face shows. Left and right are the subject's."""

    BACKGROUND = 0
    SKIN = 1
    BROW_LEFT = 2
    BROW_RIGHT = 3
    EYE_LEFT = 4
    EYE_RIGHT = 5
    NOSE = 6
    UPPER_LIP = 7
    LOWER_LIP = 8
    INNER_MOUTH = 9
    HAIR = 10
    EARS = 11
    NECK = 12
    OTHER = 13  # glasses, hands, beards, black outlines
    HAT = 14  # caps, hoods, helmets, scarves about the head


@dataclass(frozen=True, eq=False)
class HairMask:
    """The hair of one head in a picture.

    Attributes
    ----------
    mask : (H, W) bool
        Pixels of hair: of the head's hair alone, without brows, beard and hat.
    trusted : bool
        Whether it is good enough to build hair from; otherwise hair stays painted on the head.
    reasons : tuple of str
        Why it is not trusted, a short sentence each; empty if it is.
    alpha : (H, W) float32 in [0, 1], optional
        How far each pixel is covered by hair: soft where strands mix with what is behind them.
    hat : (H, W) bool, optional
        Pixels of a hat; None or all False where there is none. No pixel is hair and hat.
    """

    mask: np.ndarray
    trusted: bool
    reasons: tuple[str, ...] = ()
    alpha: np.ndarray | None = None
    hat: np.ndarray | None = None

    def __post_init__(self) -> None:
        mask = np.array(self.mask)
        if mask.ndim != 2 or mask.dtype != np.bool_:
            raise ValueError(f"mask: expected (H, W) bool, got {mask.dtype} of shape {mask.shape}")
        if self.trusted == bool(self.reasons):
            raise ValueError(f"reasons: expected some exactly if not trusted, got {self.reasons}")
        fields: dict[str, np.ndarray | None] = {"mask": mask, "alpha": None, "hat": None}
        if self.alpha is not None:
            fields["alpha"] = alpha = np.array(self.alpha, np.float32)
            if alpha.shape != mask.shape or not ((alpha >= 0) & (alpha <= 1)).all():
                raise ValueError(f"alpha: expected numbers in [0, 1] of shape {mask.shape}, got shape {alpha.shape}")
        if self.hat is not None:
            fields["hat"] = hat = np.array(self.hat)
            if hat.shape != mask.shape or hat.dtype != np.bool_ or (hat & mask).any():
                raise ValueError(f"hat: expected bool of shape {mask.shape} apart from the hair, got {hat.shape}")
        for name, array in fields.items():
            if array is not None:
                array.setflags(write=False)
            object.__setattr__(self, name, array)


@dataclass(frozen=True, eq=False)
class FaceParse:
    """A picture cut into the parts of a face.

    Attributes
    ----------
    labels : (H, W) uint8
        A :class:`FaceLabel` a pixel.
    confidence : (H, W) float in [0, 1]
        How far each label is to be believed.
    hair : HairMask, optional
        The hair that the labels follow, and whether it is to be trusted.
    """

    labels: np.ndarray
    confidence: np.ndarray
    hair: HairMask | None = None

    def __post_init__(self) -> None:
        labels, confidence = np.array(self.labels), np.array(self.confidence, np.float32)
        if labels.ndim != 2 or labels.dtype != np.uint8 or labels.max(initial=0) > max(FaceLabel):
            raise ValueError(
                f"labels: expected (H, W) uint8 up to {max(FaceLabel)}, "
                f"got {labels.shape} {labels.dtype} up to {labels.max(initial=0)}"
            )
        if confidence.shape != labels.shape:
            raise ValueError(f"confidence: expected the shape of labels {labels.shape}, got {confidence.shape}")
        if not ((confidence >= 0) & (confidence <= 1)).all():
            raise ValueError("confidence: expected numbers in [0, 1], got others or NaN")
        if self.hair is not None and self.hair.mask.shape != labels.shape:
            raise ValueError(f"hair: expected the shape of labels {labels.shape}, got {self.hair.mask.shape}")
        for name, array in (("labels", labels), ("confidence", confidence)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def mask(self, *parts: FaceLabel) -> np.ndarray:
        """Pixels (H, W) bool of any of these parts."""
        return np.isin(self.labels, parts)


class FaceParser(Protocol):
    """Cuts a picture into the parts of a face; a network, say, or the classical parser."""

    def __call__(self, img: np.ndarray, landmarks: np.ndarray, fit: "FittedFace | None" = None) -> FaceParse:
        """Labels of the picture (H, W, 3) uint8 with landmarks (68, 2) px, NaN where missing, and its fitted face."""
        ...


class HairFinder(Protocol):
    """Finds the hair in a picture; a network, say, or :func:`toongeo.find_hair`."""

    def __call__(self, img: np.ndarray, landmarks: np.ndarray, fit: "FittedFace") -> HairMask:
        """Hair of the head with landmarks (68, 2) px, NaN where missing, in a picture (H, W, 3) uint8.

        ``fit`` is the fitted face.
        """
        ...


class HairModeler(Protocol):
    """Builds hair from the pixels that show it; a network, say, or :func:`toongeo.build_hair`."""

    def __call__(self, img: np.ndarray, face: Any, rig: Any, mask: np.ndarray) -> Any:
        """Hair of the picture (H, W, 3) uint8, as a :class:`toongeo.Hair` in the model frame.

        ``face`` is a :class:`toongeo.AlignedFace` that has made room for hair, ``rig`` its :class:`toongeo.Rig`,
        ``mask`` (H, W) bool. None: there is no hair to build, and it stays painted on the head.
        """
        ...


class FittedFace(Protocol):
    """What the stages share: a face mesh in the model frame, and the camera that saw it."""

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) mm, model frame."""
        ...

    @property
    def faces(self) -> np.ndarray:
        """(m, 3) int."""
        ...

    @property
    def camera(self) -> HeadCamera:
        """From the model frame to the picture."""
        ...

    def region(self, name: str) -> np.ndarray:
        """(n,) bool: which vertices belong to the region."""
        ...


class ExpressionDriver(Protocol):
    """Reads a performance - landmarks, blend shapes of a phone, or pictures, by a network say - as weights."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names (w,) of expressions of the rig and directions of gaze."""
        ...

    def frames(self, recording: Any, fps: float) -> np.ndarray:
        """Weights (f, w) of a recording with f frames, so many a second."""
        ...


class LandmarkMapper(Protocol):
    """Takes the landmarks of a caricature to a normal face and back; a pair of networks, say, or `PartMapper`.

    ``to_caricature(*to_normal(landmarks))`` gives the landmarks back.
    """

    def to_normal(self, landmarks: np.ndarray) -> tuple[np.ndarray, Any]:
        """F+: landmarks (68, 2) px of the normal face for those of a drawing, and what ``to_caricature`` needs.

        NaN rows are missing in the drawing; the normal face has all.
        """
        ...

    def to_caricature(self, normal: np.ndarray, context: Any) -> np.ndarray:
        """F-: landmarks (68, 2) px of the drawing when its normal face has these."""
        ...


@dataclass(frozen=True, eq=False)
class TextureGeometry:
    """A face in two expressions, and its texture coordinates.

    Attributes
    ----------
    source, target : (n, 3) float64, mm, model frame
        Vertices in the expression that the texture shows, and in the one that is wanted.
    faces : (m, 3) int
    uv : (t, 2) float64
        Origin bottom left.
    uv_faces : (m, 3) int
        Corners of the faces in ``uv``.
    """

    source: np.ndarray
    target: np.ndarray
    faces: np.ndarray
    uv: np.ndarray
    uv_faces: np.ndarray

    def __post_init__(self) -> None:
        if self.source.ndim != 2 or self.source.shape[1] != 3 or self.target.shape != self.source.shape:
            raise ValueError(
                f"target: expected vertices (n, 3) like the source, got {self.target.shape} and {self.source.shape}"
            )
        if self.uv_faces.shape != self.faces.shape:
            raise ValueError(f"uv_faces: expected shape {self.faces.shape} like faces, got {self.uv_faces.shape}")
        for name in ("source", "target", "faces", "uv", "uv_faces"):
            view = getattr(self, name).view()
            view.setflags(write=False)
            object.__setattr__(self, name, view)


class TextureGenerator(Protocol):
    """What an expression does to the colours of a face (Chen et al. 2020, section 3.3); a network, say.

    It need not know where lids close and lips part, nor draw lashes: :class:`toongeo.ExpressionEditor` does.
    """

    def __call__(
        self, texture: np.ndarray, source: np.ndarray, target: np.ndarray, geometry: TextureGeometry
    ) -> tuple[np.ndarray, np.ndarray]:
        """Colour C (S, S, 3), 0-255, and attention A (S, S) in [0, 1]; ``T* = A T + (1 - A) C`` (Eq. 12).

        The texture is (S, S, 3) uint8; source and target are weights (k,) of the expressions it shows and shall show.
        """
        ...
