"""The files an avatar can be saved as."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from toongeo.avatar.clips import demo_clip, weight_clip
from toongeo.avatar.crop_faces import Crop
from toongeo.avatar.export_targets import PLAYER_MESHES, Names, export_targets, renamed_scene
from toongeo.avatar.looks.coloured_points import coloured_points
from toongeo.avatar.looks.drawn_look import drawn_look
from toongeo.avatar.scene import avatar_scene, own_shapes
from toongeo.avatar.stages import AvatarStages
from toongeo.avatar.state import encode_state
from toongeo.io import (
    Scene,
    SceneAnimation,
    VrmMeta,
    atomic_write,
    encode_glb,
    page_html,
    split_seams,
    write_glb,
    write_obj,
    write_obj_sequence,
    write_ply,
    write_usdz,
    write_vrm,
)
from toongeo.io.writers.write_usdz import usd_modules
from toongeo.model.expression_schemes import PRESETS, SCHEMES
from toongeo.pipeline import Rig

__all__ = ["avatar_attachment", "avatar_page", "page_presets", "rig_arrays", "save_avatar", "writer_for"]

_Weights = Mapping[str, float]
_Texture = Literal["png", "jpeg"] | None
_Unlit = bool | Literal["auto"]
_Animation = Literal["demo"] | None | tuple[Any, Any] | tuple[Any, Any, Any]
_EXACT_MM = 1e-4  # displacements below are not stored: less than float32 resolves at the crown of a head
_COARSE_MM = 0.04  # the same for a quantized file: a fifth of a pixel where a head is a thousand high
_COARSE_STEPS = 63  # of the confidence of the parse in a quantized file
# Fields that are not in the state: the picture and a mesh of the file, and the drawing, which is not kept.
_ELSEWHERE = ("texture", "hair", "style")


def save_avatar(path: Path, avatar: AvatarStages, kind: str | None, options: Mapping[str, Any]) -> None:
    """What :meth:`toongeo.Avatar.save` does."""
    writer_for(path, kind, options)(path, avatar, **options)


def writer_for(path: Path, kind: str | None, options: Mapping[str, Any]) -> Callable[..., None]:
    """The writer of a format, or of a suffix if that is None; errors as of :meth:`toongeo.Avatar.save`."""
    suffix = path.suffix.lower() if kind is None else kind
    writer = _WRITERS.get(suffix)
    if writer is None and kind is None:
        raise ValueError(f"path: expected a name that ends in {', '.join(_SUFFIXES)}, got {path}")
    if writer is None:
        raise ValueError(f"format: expected one of {', '.join(_WRITERS)}, got {kind!r}")
    known = list(inspect.signature(writer).parameters)[2:]
    for name in options:
        if name not in known:
            raise ValueError(f"{name}: no option of {suffix}, which has {', '.join(known)}")
    if suffix == ".usdz":
        usd_modules()
    return writer


def _write_glb(
    path: Path,
    avatar: AvatarStages,
    *,
    crop: Crop = "head",
    quantize: bool = False,
    normals: bool = False,
    texture: _Texture = "png",
    animation: _Animation = "demo",
    names: Names = "toongeo",
    sparse: bool = True,
    loadable: bool = True,
    unlit: _Unlit = "auto",
) -> None:
    scene = avatar_scene(
        avatar,
        crop=crop,
        shapes=export_targets(names),
        animation=_animation(avatar.rig, animation),
        textured=_check_texture(texture) is not None,
        unlit=_is_unlit(avatar, unlit),
    )
    player = names == "talkinghead"
    if player:
        scene = renamed_scene(scene, PLAYER_MESHES)
    whole = crop != "face" and names == "toongeo"  # else the file has not all that is needed
    write_glb(
        path,
        scene,
        normal_deltas=normals,
        tolerance_mm=_COARSE_MM if quantize else _EXACT_MM,
        quantize=quantize,
        picture=texture or "png",
        sparse=sparse,
        body="mixamo" if player else None,
        attachment=avatar_attachment(avatar, coarse=quantize) if loadable and whole else None,
    )


def _write_vrm(
    path: Path,
    avatar: AvatarStages,
    *,
    crop: Crop = "head",
    normals: bool = False,
    texture: _Texture = "png",
    meta: VrmMeta | None = None,
    unlit: _Unlit = "auto",
) -> None:
    if not avatar.eyes.templates:
        raise ValueError("avatar: expected one with eyeballs for .vrm, whose bones turn them, got none from its model")
    textured, plain = _check_texture(texture) is not None, _is_unlit(avatar, unlit)
    scene = avatar_scene(avatar, crop=crop, textured=textured, unlit=plain)
    # Bones turn the eyes, which therefore need no targets; the lids that follow are the head's.
    still = (replace(m, targets=None, target_names=()) if m.name.startswith("eye_") else m for m in scene.meshes)
    # One range for both eyes: that of the eye whose iris would leave its opening first.
    sideways, updown = avatar.eyes.turn.min(0).tolist()
    write_vrm(
        path,
        Scene(tuple(still)),
        _shown({**SCHEMES["vrm"], **SCHEMES["arkit"]}, avatar.rig),
        meta=meta,
        gaze_degrees=(sideways, updown),
        normal_deltas=normals,
        tolerance_mm=_EXACT_MM,
        picture=texture or "png",
    )


def avatar_attachment(avatar: AvatarStages, *, coarse: bool) -> bytes:
    """All of an avatar that its meshes and its texture do not tell."""
    parse = avatar.parse
    if coarse:
        steps = np.float32(_COARSE_STEPS)
        parse = replace(parse, confidence=np.rint(parse.confidence * steps) / steps)
    # The camera's picture is known to the reader as the file's image, the rig's arrays as its meshes.
    state = {f.name: getattr(avatar, f.name) for f in fields(avatar) if f.init and f.name not in _ELSEWHERE}
    state["parse"] = parse
    if avatar.hair is not None:
        # The mesh of the file has a point for each pair of these.
        vertex, uv, _ = split_seams(avatar.hair.faces, avatar.hair.uv_faces)
        state["hair"] = np.stack([vertex, uv]).astype(np.int32)
    return encode_state(state, rig_arrays(avatar.rig), avatar.face.model)


def rig_arrays(rig: Rig) -> dict[str, np.ndarray]:
    """The arrays of a rig that the meshes of a GLB hold."""
    return {"neutral": rig.neutral, "deltas": rig.deltas, "gaze": rig.gaze}


def _animation(rig: Rig, animation: _Animation) -> SceneAnimation | None:
    if animation is None:
        return None
    if isinstance(animation, tuple) and len(animation) in (2, 3):
        return weight_clip(rig, *animation)
    if isinstance(animation, str) and animation == "demo":
        return demo_clip(rig)
    raise ValueError(f"animation: expected 'demo', None, or times, weights and turns, got {animation!r}")


def _is_unlit(avatar: AvatarStages, unlit: _Unlit) -> bool:
    if unlit not in (True, False, "auto"):
        raise ValueError(f"unlit: expected True, False or 'auto', got {unlit!r}")
    return drawn_look(avatar) if unlit == "auto" else bool(unlit)


def _check_texture(texture: _Texture) -> _Texture:
    if texture not in ("png", "jpeg", None):
        raise ValueError(f"texture: expected 'png', 'jpeg' or None, got {texture!r}")
    return texture


def _write_obj(path: Path, avatar: AvatarStages, *, crop: Crop = "head") -> None:
    write_obj(path, avatar_scene(avatar, crop=crop, split=False))


def _write_obj_sequence(path: Path, avatar: AvatarStages, *, crop: Crop = "head", names: Names = "toongeo") -> None:
    shapes = export_targets(names)
    write_obj_sequence(path, avatar_scene(avatar, crop=crop, shapes=shapes, split=False))


def _write_ply(path: Path, avatar: AvatarStages, *, crop: Crop = "head") -> None:
    """Neutral head, eyeballs and hair in one mesh."""
    write_ply(path, *coloured_points(avatar_scene(avatar, crop=crop, split=False).meshes))


def _write_usdz(path: Path, avatar: AvatarStages, *, crop: Crop = "head", names: Names = "toongeo") -> None:
    shapes = export_targets(names)
    write_usdz(path, avatar_scene(avatar, crop=crop, shapes=shapes), tolerance_mm=_EXACT_MM)


def _write_html(
    path: Path,
    avatar: AvatarStages,
    *,
    crop: Crop = "head",
    quantize: bool = True,
    texture: _Texture = "png",
    animation: _Animation = "demo",
    title: str | None = None,
) -> None:
    name = path.stem if title is None else title
    page = avatar_page(avatar, name, crop=crop, quantize=quantize, texture=texture, animation=animation)
    atomic_write({path: page.encode("utf-8")})


def avatar_page(
    avatar: AvatarStages,
    title: str,
    *,
    crop: Crop = "head",
    quantize: bool = True,
    texture: _Texture = "png",
    animation: _Animation = "demo",
    framed: bool = False,
) -> str:
    """The page of an avatar; ``framed`` as of :func:`toongeo.io.page_html`, the other options as ``.html`` has them."""
    scene = avatar_scene(
        avatar,
        crop=crop,
        animation=_animation(avatar.rig, animation),
        textured=_check_texture(texture) is not None,
    )
    tolerance = _COARSE_MM if quantize else _EXACT_MM
    glb = encode_glb(scene, tolerance_mm=tolerance, quantize=quantize, picture=texture or "png")
    return page_html(glb, title=title, presets=page_presets(avatar.rig), framed=framed)


def page_presets(rig: Rig | None = None) -> dict[str, _Weights]:
    """Whole expressions that a rig can show, for the buttons of a page: no shapes of speech, no parts of faces."""
    whole: dict[str, _Weights] = {
        name: dict(weights) for name, weights in PRESETS.items() if weights and not name.startswith("viseme_")
    }
    return whole if rig is None else _shown(whole, rig)


def _shown(expressions: Mapping[str, _Weights], rig: Rig) -> dict[str, _Weights]:
    """Those among them of which a rig has all parts."""
    known = {name for name, _ in own_shapes(rig)}
    return {name: dict(weights) for name, weights in expressions.items() if known.issuperset(weights)}


_WRITERS: dict[str, Callable[..., None]] = {
    ".glb": _write_glb,
    ".obj": _write_obj,
    ".ply": _write_ply,
    ".vrm": _write_vrm,
    ".usdz": _write_usdz,
    ".html": _write_html,
    "obj-sequence": _write_obj_sequence,
}
_SUFFIXES = tuple(name for name in _WRITERS if name.startswith("."))
