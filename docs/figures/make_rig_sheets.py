"""Blinks of the example pictures with and without lids that keep contact (the ablation of Pan et al. 2024, Fig. 8).

usage: python docs/figures/make_rig_sheets.py

Rows: pictures. Columns: neutral; the blink as transferred, without the lids' correction; with it, from the front and
turned by 30 degrees; half closed.
"""

import dataclasses
from pathlib import Path

import numpy as np

from toongeo import build_rig, fit_lids, make_avatar, read_image, read_landmarks
from toongeo.avatar.avatar import Avatar
from toongeo.io import write_image
from toongeo.render import ScaledOrthographicCamera

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"
TILE, BLINK, HALF = 240, {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}, {"eyeBlinkLeft": 0.5, "eyeBlinkRight": 0.5}


def eyes_close_up(avatar: Avatar, weights: dict[str, float], yaw: float = 0.0) -> np.ndarray:
    """Both eyes, (TILE / 2, TILE, 3)."""
    centres, radii = avatar.eyes.centres, avatar.eyes.radii
    extent = np.linalg.norm(centres[0] - centres[1]) + 3.2 * radii.max()
    front = centres.mean(0) + [0, 0, 0.7 * radii.mean()]
    camera = ScaledOrthographicCamera.look(yaw, size=TILE, centre=front, extent=extent)
    return avatar.render(weights, size=TILE, camera=camera)[TILE // 5 : -TILE // 5]


def main() -> None:
    rows = []
    for picture in sorted(PORTRAITS.glob("*.png")):
        img, landmarks = read_image(picture), read_landmarks(picture.with_suffix(".pts"))
        avatar = make_avatar(img, landmarks)
        rig, eyes = fit_lids(avatar.face, build_rig(avatar.face), close=False)
        without = dataclasses.replace(avatar, rig=rig, eyes=eyes)
        tiles = [eyes_close_up(avatar, {}), eyes_close_up(without, BLINK), eyes_close_up(avatar, BLINK)]
        rows.append(np.hstack([*tiles, eyes_close_up(avatar, BLINK, 30.0), eyes_close_up(avatar, HALF)]))
    write_image(HERE / "blink_ablation.jpg", np.ascontiguousarray(np.vstack(rows)))


if __name__ == "__main__":
    main()
