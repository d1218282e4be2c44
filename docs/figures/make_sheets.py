"""Contact sheets of the seven example pictures, as small JPEGs beside this script.

usage: python docs/figures/make_sheets.py
"""

from pathlib import Path

import numpy as np

from toongeo import make_avatar, read_image, read_landmarks
from toongeo.app.contact_sheet import contact_sheet
from toongeo.io import write_image

HERE = Path(__file__).parent
PORTRAITS = HERE.parents[1] / "examples" / "portraits"


def main() -> None:
    for picture in sorted(PORTRAITS.glob("*.png")):
        img, landmarks = read_image(picture), read_landmarks(picture.with_suffix(".pts"))
        avatar = make_avatar(img, landmarks)
        sheet = contact_sheet(avatar, img, landmarks, tile=256)
        write_image(HERE / f"{picture.stem}.jpg", np.ascontiguousarray(sheet))
        print(picture.stem, *avatar.report.lines(), sep="\n  ")


if __name__ == "__main__":
    main()
