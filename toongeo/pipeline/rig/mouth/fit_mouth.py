"""A mouth that closes, whose lips do not cross, with teeth that stay in it."""

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.mouth.close_slit import close_slit
from toongeo.pipeline.rig.mouth.hang_teeth import hang_teeth
from toongeo.pipeline.rig.mouth.seal_lips import seal_lips
from toongeo.pipeline.rig.rig import Rig

__all__ = ["fit_mouth"]


def fit_mouth(face: AlignedFace, rig: Rig) -> Rig:
    """Give lips, teeth and tongue the contacts that deformation transfer does not know of.

    In this order: a mouth that is drawn closed is shut in the neutral face
    (:func:`~toongeo.pipeline.rig.mouth.close_slit.close_slit`); ``mouthClose`` seals the lips while ``jawOpen`` drops
    the jaw, and in no expression do they cross (:func:`~toongeo.pipeline.rig.mouth.seal_lips.seal_lips`); teeth and
    tongue follow this face's jaw and stay inside (:func:`~toongeo.pipeline.rig.mouth.hang_teeth.hang_teeth`).

    Parameters
    ----------
    face : AlignedFace
    rig : Rig

    Returns
    -------
    Rig
        A new one; its report has ``lips_closure``, in percent. The same, if the model has no ``mouth_cavity``, at
        whose border the lips end.
    """
    if not face.model.has("mouth_cavity"):
        return rig
    return hang_teeth(face, seal_lips(face, close_slit(face, rig)))
