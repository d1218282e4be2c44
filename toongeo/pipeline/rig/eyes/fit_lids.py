"""Eyeballs, and lids that keep contact with them."""

import dataclasses
from typing import Any

from toongeo.model.anatomy.lid_rings import lid_rings, lids_of
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.eyes.close_lids import close_lids
from toongeo.pipeline.rig.eyes.fit_eyes import Eyes, fit_eyes
from toongeo.pipeline.rig.eyes.follow_gaze import follow_gaze
from toongeo.pipeline.rig.eyes.keep_lids_outside import keep_lids_outside
from toongeo.pipeline.rig.eyes.lid_closure import lid_closure
from toongeo.pipeline.rig.eyes.rebuild_sockets import rebuild_sockets
from toongeo.pipeline.rig.eyes.seat_lids import seat_lids
from toongeo.pipeline.rig.eyes.separate_lids import separate_lids
from toongeo.pipeline.rig.eyes.unfold_lids import unfold_lids
from toongeo.pipeline.rig.rig import Rig

__all__ = ["fit_lids"]


def fit_lids(face: AlignedFace, rig: Rig, *, close: bool = True) -> tuple[Rig, Eyes]:
    """All contacts between lids and eyeballs, one step after the other.

    :func:`fit_eyes` finds the spheres, :func:`seat_lids` lays the neutral lids onto them, :func:`close_lids` makes the
    blinks close, :func:`follow_gaze` lets the lids follow the eyes, :func:`separate_lids` keeps them from passing
    through each other, :func:`keep_lids_outside` from entering the eyeballs, :func:`unfold_lids` the skin around them
    from folding, and :func:`rebuild_sockets` fills the gap behind them.

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
        As transferred.
    close : bool
        False leaves the blinks as they were transferred, but for what would be inside an eyeball.

    Returns
    -------
    Rig
        Its report has ``closure_left`` and ``closure_right``, in percent (:func:`lid_closure`).
    Eyes
        Without lids that are rings of quads around a socket, eyeballs are all there is; a model without eyeballs has
        none either.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig, eyes = tg.fit_lids(face, tg.build_rig(face))
    >>> rig.report.closure_left > 95  # percent
    True
    """
    eyes = fit_eyes(face, rig)
    if not face.model.has("eyes", *lids_of("left"), *lids_of("right")):
        return rig, eyes
    blinks = [f"eyeBlink{name.capitalize()}" for name in SIDES]
    rig = seat_lids(face, rig, eyes)
    if not face.model.has(*blinks):
        return rebuild_sockets(face, follow_gaze(face, rig, eyes), eyes), eyes
    if close:
        rig = close_lids(face, rig, eyes)
    rig = separate_lids(face, follow_gaze(face, rig, eyes), eyes)
    rig = unfold_lids(face, keep_lids_outside(face, rig, eyes), eyes)
    rig = rebuild_sockets(face, rig, eyes)
    closures: dict[str, Any] = {}
    for name, shape in zip(SIDES, blinks, strict=True):
        blink = rig.neutral + rig.deltas[rig.names.index(shape)]
        closures[f"closure_{name}"] = lid_closure(lid_rings(face.model, name), rig.neutral, blink)
    return dataclasses.replace(rig, report=dataclasses.replace(rig.report, **closures)), eyes
