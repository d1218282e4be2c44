"""What the stages gave for one avatar."""

from dataclasses import dataclass

import numpy as np

from toongeo._read_only import read_only, restored
from toongeo.avatar.report import AvatarReport
from toongeo.pipeline import AlignedFace, Eyes, FaceFit, Hair, Rig
from toongeo.protocols import FaceParse, Stylized

__all__ = ["AvatarStages"]


@dataclass(frozen=True, eq=False)
class AvatarStages:
    """The results of all stages: what writers of files need of an avatar.

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
    hair : Hair or None
        A mesh of its own, rigid on the head; None where hair is painted on the head, or there is none.
    style : Stylized or None
        The drawing of a photograph that the avatar was made of; None if it was made of the picture itself, and in
        avatars that were read from a file, which does not keep it.
    """

    fit: FaceFit
    parse: FaceParse
    face: AlignedFace
    rig: Rig
    eyes: Eyes
    texture: np.ndarray
    report: AvatarReport
    hair: Hair | None = None
    style: Stylized | None = None

    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "texture")
