"""Eyeballs, and lids that keep contact with them."""

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.clear_lids import clear_lids
from toongeo.pipeline.rig.close_lids import close_lids
from toongeo.pipeline.rig.fit_eyes import Eyes, fit_eyes
from toongeo.pipeline.rig.follow_gaze import follow_gaze
from toongeo.pipeline.rig.line_sockets import line_sockets
from toongeo.pipeline.rig.part_lids import part_lids
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.rig.seat_lids import seat_lids


def fit_lids(face: AlignedFace, rig: Rig) -> tuple[Rig, Eyes]:
    """All contacts between lids and eyeballs, one step after the other.

    :func:`fit_eyes` finds the spheres, :func:`seat_lids` lays the neutral lids onto them, :func:`close_lids` makes the
    blinks close, :func:`follow_gaze` lets the lids follow the eyes, :func:`part_lids` keeps them from passing through
    each other, :func:`clear_lids` from entering the eyeballs, and :func:`line_sockets` fills the gap behind them.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        As transferred.

    Returns
    -------
    Rig
    Eyes

    Examples
    --------
    >>> from toongeo import read_image, read_landmarks
    >>> from toongeo.pipeline import align_face, build_rig, fit_3dmm
    """
    eyes = fit_eyes(face, rig)
    rig = close_lids(face, seat_lids(face, rig, eyes), eyes)
    rig = part_lids(face, follow_gaze(face, rig, eyes), eyes)
    return line_sockets(face, clear_lids(face, rig, eyes), eyes), eyes
