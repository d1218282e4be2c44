"""Every stage in order: one picture in, an avatar out."""

import dataclasses
import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Literal

import numpy as np

from toongeo.avatar.avatar import Avatar
from toongeo.avatar.making.add_hair import GivenMask, HairyHead, add_hair, read_mask, under_hair
from toongeo.avatar.making.beyond import beyond_warnings
from toongeo.avatar.making.refined import Photometric, check_photometric, refined, refinement
from toongeo.avatar.making.rigged import mouth_warnings, posed, rigged
from toongeo.avatar.making.styled import check_stylizer, drawn_hair, styled
from toongeo.avatar.missing_parts import missing_parts
from toongeo.avatar.report import AvatarReport, detection_warnings, eye_warnings, landmark_errors, shape_warnings
from toongeo.caricature.align_caricature import align_caricature
from toongeo.io import check_image
from toongeo.metrics import mesh_quality
from toongeo.model import MorphableModel, default_model
from toongeo.pipeline import (
    AlignedFace,
    ClassicalParser,
    FaceFit,
    aim_eyes,
    align_face,
    bake_eyes,
    bake_texture,
    denoise_landmarks,
    detect_landmarks,
    find_irises,
    fit_3dmm,
    fit_cranium,
    fit_lids,
    landmark_evidence,
    parse_face,
    snap_eyes,
)
from toongeo.pipeline.align.denoise_landmarks import Noise, check_noise
from toongeo.pipeline.align.fit_ears import fit_ears
from toongeo.pipeline.align.size_teeth import size_teeth
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.parse.drawn_mouth import drawn_mouth
from toongeo.pipeline.texture.bake_texture import check_size
from toongeo.pipeline.texture.find_glasses import find_glasses
from toongeo.pipeline.texture.without_glasses import without_glasses
from toongeo.plugins import plugin
from toongeo.protocols import FaceParser, HairModeler, LandmarkDetector, Stylizer

__all__ = ["STAGES", "make_avatar"]

STAGES = ("fit", "style", "parse", "align", "rig", "eyes", "hair", "texture", "report")
_ALIGNERS: Mapping[str, Callable[[FaceFit, np.ndarray], AlignedFace]] = {
    "cartoon": partial(align_face, noise=0),  # what noise the landmarks had is out of them by then
    "caricature": align_caricature,
}


def make_avatar(
    img: np.ndarray,
    landmarks: np.ndarray | None = None,
    *,
    model: MorphableModel | None = None,
    fit: FaceFit | None = None,
    detector: str | LandmarkDetector | None = None,
    parser: str | FaceParser | None = None,
    noise: Noise = "auto",
    snap: bool = False,
    photometric: Photometric = "auto",
    neutral: bool = True,
    gain: float | Literal["auto"] = 1.0,
    method: Literal["cartoon", "caricature"] = "cartoon",
    rig: Literal["transfer", "caricature"] = "transfer",
    hair: bool | HairModeler = True,
    hair_mask: GivenMask = None,
    style: str | Stylizer | None = None,
    texture_size: int = 1024,
    scheme: Any = "ibug68",
    progress: Callable[[str], None] | None = None,
) -> Avatar:
    """A textured, rigged, animatable 3D face from one picture (the whole way of Pan et al. 2024).

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px, optional
        iBUG-68 points; x right, y down, integer = pixel centre. NaN rows are missing. None: those of the largest face
        that :func:`toongeo.detect_landmarks` finds; the report warns if it is not sure of them.
    model : MorphableModel, optional
        :func:`toongeo.default_model` unless another is given. What it does not have (eyeballs, teeth, expressions,
        texture coordinates ...) the avatar does without; ``report.warnings`` says what.
    fit : FaceFit, optional
        To these landmarks, as one of :func:`toongeo.fit_3dmm_together`: it is kept, with its identity and
        model. Not with ``snap``, ``photometric=True`` or ``style``, which fit again.
    detector : LandmarkDetector or str, optional
        Finds the landmarks if none are given: see :func:`toongeo.detect_landmarks`.
    parser : FaceParser or str, optional
        Cuts the picture into the parts of the face; :class:`toongeo.ClassicalParser` unless another is given, or the
        name of one that an installed package offers (:mod:`toongeo.plugins`).
    noise : "auto" or float
        Of the landmarks, in outer-eye distances: see :func:`toongeo.align_face`. What was found and done about it is in
        ``face.report.noise`` and, in words, in ``report.warnings``.
    snap : bool
        Move eye landmarks to the lids that the parser found (:func:`toongeo.snap_eyes`), and fit again. For points of a
        detector, which shrinks and shifts the eyes of drawings; points that were set by hand are better left alone.
    photometric : bool or "auto"
        Refine the fit by the picture, which also finds albedo and light (:func:`toongeo.photometric_fit`). "auto":
        where shading tells of the shape, which is in photographs of people whom the model meets well; not of a ``fit``
        that is given, nor of a picture that ``style`` draws.
    neutral : bool
        Close a mouth that is drawn open (:func:`toongeo.neutral_face`): ``avatar.vertices()`` is
        then at rest, ``avatar.vertices(avatar.pose)`` as in the picture. False: the face is taken for neutral as
        it is drawn.
    gain : float or "auto"
        Strength of the transferred expressions; see :func:`toongeo.build_rig`.
    method : {"cartoon", "caricature"}
        How the fitted face comes to its landmarks: by :func:`toongeo.align_face`, or in the deformation space of
        exaggerated faces by :func:`toongeo.fit_caricature`, which also finds the pose anew: ``face.camera``. That
        takes three to four times as long and looks no better; ask for it where you go on with its weights, as
        ``rig="caricature"`` does.
    rig : {"transfer", "caricature"}
        Where the expressions come from: the template's, by deformation transfer, or the drawing's own, reconstructed
        from landmarks that keep its exaggeration (:func:`toongeo.caricature_rig`), which takes a quarter of a
        minute.
    hair : bool or HairModeler
        Build hair as a mesh of its own, for which the skull gives way (:func:`toongeo.make_room`,
        :func:`toongeo.build_hair`, or what is given). Where the hair of the picture cannot be told from the rest,
        ``report.warnings`` says so and all is as with False: hair is painted on the head.
    hair_mask : (H, W) array_like or path, optional
        Pixels of hair, made by hand or by another program, in place of :func:`toongeo.find_hair`: bool, or 0..255.
    style : {"toon", "chibi", "caricature", "ink", "painted"} or Stylizer, optional
        Draw the photograph first (:func:`toongeo.stylize`, or what is given): the head is made of the drawing. None
        takes the picture as it is, as drawings want.
    texture_size : int
        Side of the texture atlas in texels.
    scheme : str, or a table
        What the landmarks are: see :func:`toongeo.ibug_landmarks`. With a table of points on the model (as of
        :class:`toongeo.FitOptions`) the face is fitted to these, and then stands for its 68 landmarks.
    progress : callable, optional
        Called with the name of each stage before it starts: one of ``STAGES``.

    Returns
    -------
    Avatar
        What each stage gave is kept in it: ``fit``, ``parse``, ``face``, ``rig``, ``eyes``, ``texture``, ``report``,
        ``hair``, ``style``.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, the landmarks cannot belong to it, no face was found where none are
        given, method, rig, hair, style, noise or photometric is unknown, or a fit comes without landmarks or with what
        would change it.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> avatar = tg.make_avatar(img, landmarks, hair=False)
    >>> avatar.vertices({"jawOpen": 0.6}).shape  # mm
    (19057, 3)
    >>> avatar.save("face.glb")
    """
    align = _ALIGNERS.get(method)
    if align is None:
        raise ValueError(f"method: expected one of {', '.join(_ALIGNERS)}, got {method!r}")
    check_image(img)
    check_size(texture_size)
    if rig not in ("transfer", "caricature"):
        raise ValueError(f"rig: expected 'transfer' or 'caricature', got {rig!r}")
    if not (isinstance(hair, bool) or callable(hair)):
        raise ValueError(
            f"hair: expected True, False or a HairModeler, got {type(hair).__name__}; masks are hair_mask="
        )
    check_noise(noise)
    stylizer = check_stylizer(style)
    check_photometric(photometric)
    changed = snap or photometric is True or stylizer is not None or not isinstance(scheme, str)
    if fit is not None and (landmarks is None or changed):
        raise ValueError("fit: expected landmarks by name with it, and no snap, photometric or style, which fit again")
    clock = _Clock(progress)

    clock.start("fit")
    doubts: tuple[str, ...] = ()
    if landmarks is None:
        found = detect_landmarks(img, detector=detector)
        landmarks, scheme, doubts = found.points, "ibug68", detection_warnings(found)
    kept, model = fit, fit.model if fit is not None else model or default_model()
    if isinstance(scheme, str):
        landmarks = ibug_landmarks(landmarks, scheme)
        fit = kept or fit_3dmm(img, landmarks, model=model)
    else:
        fit = fit_3dmm(img, landmarks, model=model, scheme=scheme)
        landmarks = fit.project(fit.vertices[fit.landmark_vertices])
    given, cleaned = landmarks, denoise_landmarks(fit, landmarks, noise)
    if cleaned.change:
        landmarks = cleaned.points
        fit = kept or fit_3dmm(img, landmarks, model=model)
    drawn, faults = read_mask(hair_mask, img.shape)
    drawing = None
    if stylizer is not None:
        clock.start("style")
        drawing = styled(img, landmarks, stylizer)
        drawn = None if drawn is None else drawing.warp.picture(drawn.astype(np.float32)) > 0.5
        img, landmarks = drawing.texture, drawing.landmarks
        given = landmarks
        fit = fit_3dmm(img, landmarks, model=model)
    clock.start("parse")
    by: FaceParser | None = plugin(parser, "parser")
    hair_seen = None if drawing is None else drawn_hair(drawing)
    if by is None and drawn is None and hair_seen is not None:
        by = ClassicalParser(hair_finder=lambda *_: hair_seen)  # it is not looked for twice
    parse = parse_face(img, landmarks, fit, parser=by, hair_mask=drawn)
    if snap:
        clock.start("fit")
        landmarks = snap_eyes(landmarks, parse)
        fit = fit_3dmm(img, landmarks, model=model)
    if photometric is True or (kept is None and drawing is None and isinstance(scheme, str)):
        how = refinement(img, fit, photometric)
        if how is not None:
            clock.start("fit")
            fit = refined(img, fit, landmarks, how, asked=photometric is True)
    clock.start("align")
    goal = given if cleaned.change else landmarks  # errors are told against the points that were given, or snapped
    face = align(fit, landmarks)
    face = dataclasses.replace(face, report=dataclasses.replace(face.report, noise=cleaned.change))
    face = size_teeth(fit_ears(fit_cranium(face, parse), parse), drawn_mouth(img, parse))
    clock.start("rig")
    neutral_aligned, shapes, drawn_face = rigged(face, landmarks, rig, neutral=neutral, gain=gain)
    clock.start("eyes")
    before = shapes.neutral
    shapes, eyes = fit_lids(neutral_aligned, shapes)
    # What this stage did to the neutral face (lids that lie on the eyeballs) is done to the face of the picture.
    face = dataclasses.replace(face, vertices=shapes.neutral + (drawn_face - before))
    face, shapes = posed(face, shapes)
    aligned = landmark_errors(face, goal)  # before points under hair give way to it
    head = HairyHead(face, shapes, None, faults)
    if hair and not faults:
        clock.start("hair")
        head = add_hair(img, face, shapes, parse, None if hair is True else hair)
        face, shapes = head.face, head.rig
    clock.start("texture")
    glasses = find_glasses(img, landmarks)
    bare = img if glasses is None else without_glasses(img, landmarks, glasses, parse)
    irises = find_irises(bare, landmarks)
    eyes = aim_eyes(face, eyes, irises)
    shown = parse if head.hair is None else under_hair(parse, face)
    texture = bake_texture(bare, face, rig=shapes, size=texture_size, parse=shown)
    texture = bake_eyes(bare, face, eyes, texture, irises)
    clock.start("report")
    quality = mesh_quality(face.vertices, face.faces[face.region("face")[face.faces].all(1)])
    report = AvatarReport(
        coarse=landmark_errors(fit, goal),
        aligned=aligned,
        quality=quality,
        seconds=clock.stop(),
        warnings=(
            *doubts,
            *fit.report.warnings,
            *([str(cleaned.change)] if cleaned.change else []),
            *beyond_warnings(landmark_evidence(img, goal), goal, face, shapes, glasses),
            *missing_parts(model),
            *shape_warnings(face, eyes, quality),
            *(eye_warnings(irises) if model.has("eyes") else ()),
            *mouth_warnings(face, shapes),
            *(f"hair is painted on the head: {reason}" for reason in head.reasons),
        ),
    )
    return Avatar(
        fit=fit,
        parse=parse,
        face=face,
        rig=shapes,
        eyes=eyes,
        texture=texture,
        report=report,
        hair=head.hair,
        style=drawing,
    )


class _Clock:
    """Seconds a stage, and a word to the caller before each."""

    def __init__(self, progress: Callable[[str], None] | None) -> None:
        self._progress = progress
        self._seconds: dict[str, float] = {}
        self._running: tuple[str, float] | None = None

    def start(self, stage: str) -> None:
        self.stop()
        if self._progress:
            self._progress(stage)
        self._running = (stage, time.perf_counter())

    def stop(self) -> dict[str, float]:
        if self._running:
            stage, started = self._running
            self._seconds[stage] = self._seconds.get(stage, 0.0) + time.perf_counter() - started
            self._running = None
        return self._seconds
