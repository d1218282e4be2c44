"""A picture of a random head with known hair and hat: painted in layers, then made a photo, a painting or a drawing."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from noise import Floats, Rng, chance, clouds, smooth_field
from numpy.typing import NDArray
from random_clothes import random_clothes
from random_ground import random_ground
from random_hair import HairShape, hair_colour, random_hair, strands
from random_hat import Hat, random_hat
from random_head import Head, Mask, paint_features, random_head

from toongeo.model import MorphableModel

__all__ = ["HAIR", "HAT", "OTHER", "Picture", "cropped", "random_picture"]

OTHER, HAIR, HAT = 0, 1, 2
_SIDE = 400  # px; a head is then about as large as the view in which hair is looked for


@dataclass(frozen=True, eq=False)
class Picture:
    """img (h, w, 3) uint8, labels (h, w) uint8 of OTHER, HAIR, HAT, and landmarks (68, 2) px."""

    img: NDArray[np.uint8]
    labels: NDArray[np.uint8]
    landmarks: NDArray[np.float64]


def random_picture(rng: Rng, model: MorphableModel) -> Picture:
    exaggeration = float(rng.choice([0.0, rng.uniform(0.3, 1.0)], p=[0.4, 0.6]))
    style = str(rng.choice(["photo", "painting", "drawing"], p=[0.3, 0.4, 0.3]))
    drawn = style == "drawing"
    head = random_head(rng, model, _SIDE, exaggeration)
    hair = hair_colour(rng, drawn, np.median(head.colour[head.face], axis=0))
    shape = random_hair(rng, head, exaggeration)
    hat = random_hat(rng, head, hair) if chance(rng, 0.14) else None
    if hat is not None:
        shape = shape.below(head.up, hat.rim)
    img, labels = _layers(rng, head, hair, shape, hat, drawn)
    landmarks = head.landmarks
    if drawn or (style == "painting" and chance(rng, 0.4)):
        _ink(rng, img, labels, head)
    img, labels, landmarks = _bent(rng, img, labels, landmarks, 0.012 + 0.03 * exaggeration)
    img = _developed(rng, img, style)
    unit = np.linalg.norm(landmarks[36] - landmarks[45])
    landmarks = landmarks + rng.normal(0, 0.012 * unit, landmarks.shape)
    return cropped(rng, Picture(img, labels, landmarks))


def _layers(
    rng: Rng, head: Head, hair: Floats, shape: HairShape, hat: Hat | None, drawn: bool
) -> tuple[Floats, NDArray[np.uint8]]:
    img = random_ground(rng, _SIDE, hair, drawn)
    labels = np.zeros(head.seen.shape, np.uint8)
    look = strands(rng, head, hair, shape.curl, drawn)
    edge = (rng.uniform(0.3, 0.8) if drawn else rng.uniform(0.4, 2.2)) * shape.fade
    if not drawn and chance(rng, 0.25):  # its shadow on the wall
        _shade(rng, img, head.seen | shape.front | shape.behind)
    _lay(img, labels, shape.behind, look * rng.uniform(0.45, 1.0), HAIR, edge)
    clothes, cloth = random_clothes(rng, head, hair, drawn)
    first = chance(rng, 0.6)  # hair falls behind or over the shoulders
    if not first:
        _lay(img, labels, clothes & ~shape.behind, cloth, OTHER, 0.6)
    skin = _lit(rng, head, hair, drawn)
    paint_features(rng, skin, head, hair)
    _lay(img, labels, head.seen, skin, OTHER, 0.5)
    if first:
        _lay(img, labels, clothes, cloth, OTHER, 0.6)
    else:
        _lay(img, labels, clothes & head.neck & (head.up < -0.7), cloth, OTHER, 0.6)
    if shape.any and not drawn:
        _shade(rng, img, shape.front, only=head.seen)
    _lay(img, labels, shape.front, look, HAIR, edge)
    if shape.any and chance(rng, 0.4):
        _flyaways(rng, img, labels, head, hair)
    if hat is not None:
        _lay(img, labels, hat.mask, hat.look, HAT, 0.6)
    return img, labels


def _lay(img: Floats, labels: NDArray[np.uint8], mask: Mask, look: Floats, label: int, edge: float) -> None:
    """Put a layer with a soft edge over picture and labels, in place."""
    alpha = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), edge)[..., None]
    img[:] = img * (1 - alpha) + look * alpha
    labels[mask] = label


def _shade(rng: Rng, img: Floats, mask: Mask, only: Mask | None = None) -> None:
    """A soft shadow that a mask throws, in place."""
    dx, dy = rng.normal(0, 6), rng.uniform(2, 14)
    shifted = cv2.warpAffine(mask.astype(np.float32), np.array([[1, 0, dx], [0, 1, dy]]), mask.shape[::-1])
    shade = cv2.GaussianBlur(shifted, (0, 0), rng.uniform(2, 8)) * rng.uniform(0, 0.55)
    if only is not None:
        shade = shade * only
    img *= (1 - shade)[..., None]


def _lit(rng: Rng, head: Head, hair: Floats, drawn: bool) -> Floats:
    """The head's skin under random lamps; beards, stubble, make-up of a whole tone."""
    skin = head.colour * rng.uniform(0.45, 1.1) if not drawn else np.ones_like(head.colour) * _skin_tone(rng)
    if not drawn and chance(rng, 0.4):  # painters have their own tones
        skin = head.colour * (_skin_tone(rng) / np.median(head.colour[head.face], axis=0))
    if chance(rng, 0.08):
        skin = skin * rng.uniform(0.4, 1.3, 3)
    if chance(rng, 0.4):
        low = (head.height < rng.uniform(-75, -35) + 45 * np.abs(head.turn) ** rng.uniform(1, 3)) & head.face
        if chance(rng, 0.4):
            low &= np.abs(head.turn) < rng.uniform(0.3, 0.6)
        beard = cv2.GaussianBlur(low.astype(np.float32), (0, 0), rng.uniform(0.6, 4))[..., None] * rng.uniform(0.15, 1)
        grain = 1 + rng.uniform(0, 0.3) * clouds(rng, low.shape, 0.95)[..., None]
        skin = skin * (1 - beard) + hair * rng.uniform(0.6, 1.1) * grain * beard
    if not drawn:  # blotches, folds and wrinkles
        skin = skin * (1 + rng.uniform(0, 0.09) * clouds(rng, head.seen.shape, 0.9))[..., None]
        skin = skin * (1 - _folds(rng, head))[..., None]
    ambient = rng.uniform(0.35, 0.85)
    light = np.full(head.seen.shape, ambient, np.float32)
    for _ in range(int(rng.integers(1, 3))):
        lamp = rng.normal(size=3) + [0, 0.5, rng.choice([0.2, 1.0])]
        lamp /= np.linalg.norm(lamp)
        light += np.clip(head.normal @ lamp.astype(np.float32), 0, 1) * rng.uniform(0.4, 1.0) * (1.15 - ambient)
    light *= 1 - _hollows(rng, head) * (0.4 if drawn else 1)
    if drawn:
        light = np.full_like(light, 1.0) if chance(rng, 0.5) else np.round(light * 2) / 2 * 0.5 + 0.5
    elif chance(rng, 0.7):  # shiny skin
        lamp = np.array([rng.normal(0, 0.4), 0.5, 0.8], np.float32)
        shine = np.clip(head.normal @ (lamp / np.linalg.norm(lamp)), 0, 1) ** rng.uniform(6, 50)
        return np.clip(skin * light[..., None] + shine[..., None] * rng.uniform(0, 130), 0, 255)
    return np.clip(skin * light[..., None], 0, 255)


def _hollows(rng: Rng, head: Head) -> Floats:
    """How far (h, w) hollows (lower than their surroundings) and turned-away rims are darkened."""
    dark = np.zeros(head.seen.shape, np.float32)
    for reach, depth in ((0.018, 14.0), (0.006, 6.0)):
        around = cv2.GaussianBlur(head.depth, (0, 0), reach * _SIDE)
        dark += np.clip((around - head.depth) / depth, 0, 1) * rng.uniform(0, 0.8)
    if chance(rng, 0.45):
        dark += (1 - np.clip(head.normal[..., 2], 0, 1)) ** 2 * rng.uniform(0.2, 0.9)
    return np.clip(dark, 0, 0.85)


def _folds(rng: Rng, head: Head) -> Floats:
    """How far (h, w) wrinkles of the forehead and folds beside nose and mouth darken the skin."""
    canvas = np.zeros(head.seen.shape, np.float32)
    points, unit = head.landmarks, float(np.linalg.norm(head.landmarks[36] - head.landmarks[45]))
    lines = [
        points[[31, 48]] + [-0.12 * unit, 0],
        points[[35, 54]] + [0.12 * unit, 0],
        points[[36, 31]],
        points[[45, 35]],
    ]
    brows = points[17:27:3]
    lines += [brows + head.upright * unit * rng.uniform(0.15, 0.6) for _ in range(3)]
    for line in lines:
        if chance(rng, 0.5):
            line = np.rint(line + rng.normal(0, 0.03 * unit, line.shape)).astype(np.int32)
            cv2.polylines(canvas, [line], False, rng.uniform(0.1, 0.6), int(rng.integers(1, 4)), cv2.LINE_AA)
    return np.asarray(cv2.GaussianBlur(canvas, (0, 0), rng.uniform(0.6, 3)), np.float32)


def _skin_tone(rng: Rng) -> Floats:
    tones = np.array([[250, 222, 196], [240, 200, 165], [214, 160, 120], [150, 100, 70], [92, 60, 44], [255, 236, 190]])
    if chance(rng, 0.1):
        return np.asarray(rng.uniform(60, 255, 3), np.float32)
    return np.asarray(tones[rng.integers(len(tones))] + rng.normal(0, 8, 3), np.float32)


def _flyaways(rng: Rng, img: Floats, labels: NDArray[np.uint8], head: Head, hair: Floats) -> None:
    """Single hairs about the outline: seen, but no part of the mask; in place."""
    canvas = np.zeros(labels.shape, np.float32)
    for _ in range(int(rng.integers(10, 90))):
        angle = rng.uniform(-2, 2)
        root = 0.42 * np.array([np.sin(angle), np.cos(angle)])
        tip = root * rng.uniform(1.1, 1.5) + rng.normal(0, 0.07, 2)
        line = head.place(np.array([root, (root + tip) / 2 + rng.normal(0, 0.02, 2), tip]))
        cv2.polylines(canvas, [np.rint(line).astype(np.int32)], False, rng.uniform(0.2, 0.7), 1, cv2.LINE_AA)
    near = cv2.dilate((labels == HAIR).astype(np.uint8), np.ones((25, 25), np.uint8)) > 0
    alpha = (canvas * near)[..., None]
    img[:] = img * (1 - alpha) + hair * alpha


def _ink(rng: Rng, img: Floats, labels: NDArray[np.uint8], head: Head) -> None:
    """Outlines of head, hair and hat, and strokes within the hair, in place."""
    if chance(rng, 0.25):
        return
    ink = float(rng.uniform(0, 60))
    edges = cv2.morphologyEx(labels, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    edges |= cv2.morphologyEx(head.seen.astype(np.uint8), cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    line = edges.astype(np.float32)
    rows, columns = np.nonzero(labels == HAIR)
    for _ in range(int(rng.integers(0, 40)) if len(rows) else 0):
        k = rng.integers(len(rows))
        start = np.array([columns[k], rows[k]], float)
        way = start - head.place(np.array([[0.0, 0.6]]))[0]
        end = start + way / max(float(np.linalg.norm(way)), 1) * rng.uniform(8, 60) + rng.normal(0, 4, 2)
        cv2.line(line, tuple(map(int, start)), tuple(map(int, end)), 1.0, int(rng.integers(1, 3)), cv2.LINE_AA)
    alpha = np.clip(cv2.GaussianBlur(line, (0, 0), rng.uniform(0.5, 1.6)) * rng.uniform(1.2, 3), 0, 1)[..., None]
    img[:] = img * (1 - alpha) + ink * alpha


def _bent(rng: Rng, img: Floats, labels: NDArray[np.uint8], landmarks, amount: float):
    """The picture pulled about by a smooth field, as a hand that draws would; landmarks follow."""
    shape = labels.shape
    dx, dy = (smooth_field(rng, shape, 4) * np.float32(amount * _SIDE) for _ in range(2))
    y, x = np.mgrid[: shape[0], : shape[1]].astype(np.float32)
    img = cv2.remap(img, x + dx, y + dy, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    labels = cv2.remap(labels, x + dx, y + dy, cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE)
    moved = landmarks.copy()
    for _ in range(10):  # the inverse, by fixed-point iteration
        at = moved.astype(np.float32)[:, None]
        shift = [cv2.remap(d, at, None, cv2.INTER_LINEAR)[:, 0] for d in (dx, dy)]
        moved = landmarks - np.stack(shift, axis=1)
    return img, labels, moved


def _developed(rng: Rng, img: Floats, style: str) -> NDArray[np.uint8]:
    """Film, paint or print: filters, tone, tint, grain, compression."""
    img = np.clip(img, 0, 255)
    if style == "painting":
        for _ in range(int(rng.integers(1, 3))):
            img = cv2.bilateralFilter(np.float32(img), 7, rng.uniform(15, 60), 5)
        stroke = cv2.GaussianBlur(rng.normal(0, 1, img.shape[:2]).astype(np.float32), (0, 0), sigmaX=0.8, sigmaY=4)
        img = img + (stroke / stroke.std())[..., None] * rng.uniform(0, 9)
    tint = rng.random()
    if tint < 0.14:
        img = np.repeat(img.mean(2, keepdims=True), 3, 2)
    elif tint < 0.34:  # one colour over all
        grey = img.mean(2, keepdims=True)
        img = (grey + (img - grey) * rng.uniform(0.2, 1)) * rng.uniform(0.75, 1.15, 3)
    img = 255 * (np.clip(img, 0, 255) / 255) ** rng.uniform(0.6, 1.7)
    if chance(rng, 0.75):  # exposed as pictures are
        low, high = np.percentile(img, [2, 97])
        img = (img - low) / max(high - low, 30) * rng.uniform(170, 250) + rng.uniform(0, 25)
    img = (img - 128) * rng.uniform(0.75, 1.15) + 128 + rng.normal(0, 10)
    if chance(rng, 0.5):
        img = cv2.GaussianBlur(np.float32(img), (0, 0), rng.uniform(0.3, 1.6))
    if style != "drawing" or chance(rng, 0.2):
        img = img + rng.normal(0, rng.uniform(0, 7), img.shape)
    out = np.clip(img, 0, 255).astype(np.uint8)
    if chance(rng, 0.3):
        quality = int(rng.integers(25, 90))
        out = cv2.imdecode(cv2.imencode(".jpg", out, [cv2.IMWRITE_JPEG_QUALITY, quality])[1], cv2.IMREAD_COLOR)
    return np.asarray(out, np.uint8)


def cropped(rng: Rng, picture: Picture) -> Picture:
    """Cut as pictures are: close or wide, seldom through the hair."""
    if chance(rng, 0.3):
        return picture
    rows, columns = np.nonzero(picture.labels) if picture.labels.any() else (np.array([100]), np.array([210]))
    points = picture.landmarks
    least = -12 if chance(rng, 0.15) else 2
    x0 = min(points[:, 0].min() - 10, columns.min() - rng.uniform(least, 60))
    x1 = max(points[:, 0].max() + 10, columns.max() + rng.uniform(least, 60))
    y0 = min(points[:, 1].min() - 10, rows.min() - rng.uniform(least, 70))
    height, width = picture.labels.shape
    y1 = max(points[:, 1].max() + 8, rng.uniform(points[:, 1].max(), height))
    x0, y0 = int(max(0, x0)), int(max(0, y0))
    box = slice(y0, int(min(height, y1)) + 1), slice(x0, int(min(width, x1)) + 1)
    return Picture(np.ascontiguousarray(picture.img[box]), picture.labels[box].copy(), points - [x0, y0])
