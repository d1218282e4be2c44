"""Editing the expression of pictures: what is kept, what it costs, and how textures compare with known ones.

usage: python benchmarks/editing.py [FOLDER ...]

Landmarks lie beside each picture (.pts or .txt); without a folder the seven examples are used. For each: mean
difference, of 255 inside the face, between the picture and its own expression rendered; the same after editing to
another expression, fitting the edited picture anew, and editing back; the largest difference outside the region that
may be touched; CPU time of a frame with the picture at 512 px, and of its texture at 512 x 512.

Then attention and colour errors (Chen et al. 2020, Eq. 13 and 14) of the classical generator on the template, whose
textures in known expressions are rendered: skin under a known light, the mouth of the template. Beside it: without
attention (A = 0), and the source texture unchanged. The inside of the mouth is counted by itself: its colours are
chosen to suit the palette of the face, and cannot be those of the template.
"""

import sys
import time

import cv2
import numpy as np
from pictures import Picture, pictures, roles

from toongeo import (
    ClassicalTextureGenerator,
    ExpressionEditor,
    TextureGeometry,
    attention_map,
    compose_texture,
    default_model,
    read_image,
    read_landmarks,
)
from toongeo.editing.texture.atlas_raster import AtlasRaster
from toongeo.editing.texture.openings import lips_parted
from toongeo.geometry import vertex_normals
from toongeo.pipeline import align_face, build_rig, fit_3dmm, fit_lids
from toongeo.render import ScaledOrthographicCamera, irradiance, linear_to_srgb, srgb_to_linear, studio_light

SIDE = 512  # px and texels
THERE = {"mouthSmileLeft": 0.7, "mouthSmileRight": 0.7, "jawOpen": 0.2, "browInnerUpLeft": 0.5, "browInnerUpRight": 0.5}
TARGETS: dict[str, dict[str, float]] = {
    "open": {"jawOpen": 0.7},
    "smile": {"mouthSmileLeft": 0.9, "mouthSmileRight": 0.9},
    "pout": {"mouthPucker": 0.9},
    "blink": {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0},
    "brows": {"browInnerUpLeft": 1.0, "browInnerUpRight": 1.0},
}


def main(found: list[Picture]) -> None:
    print("picture              own   there and back  outside  frame ms  texture ms")
    for picture in found:
        print(f"{picture.name:18s}", *_picture_row(picture), flush=True)
    print(roles("editing", [picture.name for picture in found]))
    print(
        "\nexpression  attention, Eq. 13  colour, Eq. 14  no attention  source as it is  mouth: colour  source as it is"
    )
    for row in _texture_rows():
        print(*row)


def _picture_row(picture: Picture) -> list[str]:
    img, landmarks = _resized(picture)
    editor = ExpressionEditor(img, landmarks)
    face = _face_pixels(landmarks, img.shape)
    own = np.abs(editor.frame(editor.pose).astype(int) - img)
    wanted = editor.pose.copy()
    for name, weight in THERE.items():
        wanted[editor.avatar.rig.names.index(name)] = weight
    there = editor.frame(wanted)
    # The expression of the edited picture is known; its face, rig and texture are found anew.
    again = ExpressionEditor(there, editor.landmarks(wanted), pose=wanted[: len(editor.avatar.rig.names)])
    back = again.frame(editor.pose[: len(editor.avatar.rig.names)])
    outside = np.abs(there.astype(int) - img)[~editor.region].max(initial=0)
    frame = min(_cpu(lambda: editor.frame(wanted)) for _ in range(5))
    texture = min(_cpu(lambda: _texture(editor, wanted)) for _ in range(5))
    differences = own[face].mean(), np.abs(back.astype(int) - img)[face].mean()
    return [f"{differences[0]:6.2f}", f"{differences[1]:15.2f}", f"{outside:8d}", f"{frame:9.0f}", f"{texture:11.0f}"]


def _resized(picture: Picture) -> tuple[np.ndarray, np.ndarray]:
    """Picture with its longer side at 512 px."""
    img, landmarks = read_image(picture.image), read_landmarks(picture.landmarks)
    scale = SIDE / max(img.shape[:2])
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    resized = cv2.resize(img, None, fx=scale, fy=scale, interpolation=how)
    return np.ascontiguousarray(resized, np.uint8), (landmarks + 0.5) * scale - 0.5


def _face_pixels(landmarks: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Pixels (H, W) bool within the hull of the landmarks."""
    hull = cv2.convexHull(np.rint(landmarks).astype(np.int32))
    return np.asarray(cv2.fillConvexPoly(np.zeros(shape[:2], np.uint8), hull, 1)).astype(bool)


def _cpu(call) -> float:  # type: ignore[no-untyped-def]
    """CPU milliseconds of a call."""
    started = time.process_time()
    call()
    return 1000 * (time.process_time() - started)


def _texture(editor: ExpressionEditor, weights: np.ndarray) -> np.ndarray:
    avatar = editor.avatar
    model = avatar.face.model
    geometry = TextureGeometry(avatar.face.vertices, editor.vertices(weights), model.faces, model.uv, model.uv_faces)
    colour, attention = editor._generator(avatar.texture, editor.pose, weights, geometry)
    return compose_texture(avatar.texture, colour, attention)


def _texture_rows() -> list[list[str]]:
    model = default_model()
    camera = ScaledOrthographicCamera.look(size=SIDE)
    fit = fit_3dmm(None, camera.project(model.mean[model.landmarks]))
    face = align_face(fit, camera.project(model.mean[model.landmarks]))
    rig, _ = fit_lids(face, build_rig(face))
    raster = AtlasRaster(model.faces, model.uv, model.uv_faces, SIDE)
    inner = np.any([model.region(name) for name in ("mouth_cavity", "teeth_upper", "teeth_lower", "tongue")], axis=0)
    skin, mouth = (
        raster.image(part.astype(np.float32)[:, None])[..., 0] > 0.99 for part in (model.region("face"), inner)
    )
    source = _rendered(model, raster, rig.neutral, inner)
    generator = ClassicalTextureGenerator(model, rig, source)
    rows = []
    for name, weights in TARGETS.items():
        V = rig.vertices(weights)
        geometry = TextureGeometry(rig.neutral, V, model.faces, model.uv, model.uv_faces)
        truth, motion = _rendered(model, raster, V, inner).astype(float), attention_map(geometry, SIDE)
        colour, attention = generator(source, rig.weights(None), rig.weights(weights), geometry)
        made = compose_texture(source, colour, attention)
        off = [np.abs(image - truth) for image in (made, colour, source)]
        numbers = np.abs(attention - motion)[skin].mean(), *(part[skin].mean() for part in off)
        numbers += off[0][mouth].mean(), off[2][mouth].mean()
        rows.append([f"{name:10s}", f"{numbers[0]:18.4f}", *(f"{number:15.2f}" for number in numbers[1:])])
    return rows


def _rendered(model, raster: AtlasRaster, V: np.ndarray, inner: np.ndarray) -> np.ndarray:  # type: ignore[no-untyped-def]
    """Texture (S, S, 3) uint8 of the template in an expression: its albedo under the studio light.

    Into the mouth falls as much light as the lips let in.
    """
    shade = np.maximum(irradiance(vertex_normals(V, model.faces), studio_light()) / np.pi, 0.05)
    shade[inner] *= 0.2 + 0.8 * lips_parted(model, V)
    colours = linear_to_srgb(np.clip(srgb_to_linear(model.albedo_mean.astype(float)) * shade, 0, 1))
    return np.clip(np.rint(255 * raster.image(colours)), 0, 255).astype(np.uint8)


if __name__ == "__main__":
    main(pictures(sys.argv[1:]))
