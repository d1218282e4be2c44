"""A mouth that closes, whose lips do not cross, with teeth that stay in it."""

import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.mouth.close_slit import close_slit
from toongeo.pipeline.rig.mouth.hang_teeth import hang_teeth
from toongeo.pipeline.rig.mouth.open_as_drawn import open_as_drawn
from toongeo.pipeline.rig.mouth.seal_lips import seal_lips
from toongeo.pipeline.rig.mouth.unfold_mouth import unfold_mouth
from toongeo.pipeline.rig.rig import Rig

__all__ = ["fit_mouth"]


def fit_mouth(face: AlignedFace, rig: Rig, drawn: np.ndarray | None = None) -> Rig:
    """Give lips, teeth and tongue the contacts that deformation transfer does not know of.

    In this order: a mouth that is drawn closed is shut in the neutral face
    (:func:`~toongeo.pipeline.rig.mouth.close_slit.close_slit`); ``mouthClose`` seals the lips while ``jawOpen`` drops
    the jaw, and in no expression do they cross (:func:`~toongeo.pipeline.rig.mouth.seal_lips.seal_lips`) or does the
    skin around them fold (:func:`~toongeo.pipeline.rig.mouth.unfold_mouth.unfold_mouth`); teeth and tongue follow this
    face's jaw and stay inside (:func:`~toongeo.pipeline.rig.mouth.hang_teeth.hang_teeth`).

    Parameters
    ----------
    face : AlignedFace
    rig : Rig
    drawn : (n, 3) float64, mm, optional
        Vertices of the face of the picture, where :func:`toongeo.neutral_face` closed its mouth: the rig is made to
        show it (:func:`~toongeo.pipeline.rig.mouth.open_as_drawn.open_as_drawn`).

    Returns
    -------
    Rig
        A new one; its report has ``lips_closure``, in percent. The same, if the model has no ``mouth_cavity``, at
        whose border the lips end.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> rig = tg.fit_mouth(face, tg.build_rig(face))
    >>> rig.report.lips_closure > 95  # percent
    True
    """
    if not face.model.has("mouth_cavity"):
        return rig
    rig = seal_lips(face, close_slit(face, rig))
    if drawn is not None:
        # What the contacts took from the picture's pose is among what is given back, and it must not undo them.
        rig = seal_lips(face, open_as_drawn(face, rig, drawn))
    return hang_teeth(face, unfold_mouth(face, rig))
