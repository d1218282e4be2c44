"""Three of our expressions on a head of another topology, above that head's own, as a JPEG beside this script.

The head is the neutral one of ICT-FaceKit (R. Li et al., CVPR 2020; MIT license), which brings expressions of its own;
`toongeo.rig_mesh` sees its triangles and 68 landmarks alone.

usage: python docs/figures/make_foreign_rig.py ict_facekit_light.npz [OUT.jpg]
"""

import sys
from pathlib import Path

import cv2
import numpy as np

from toongeo import MorphableModel, Rig, ScaledOrthographicCamera, render_mesh, rig_mesh
from toongeo.io import write_image
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit
from toongeo.render import Surface

HERE = Path(__file__).parent
# Ours, and what it is called there.
NAMES = {"": "", "jawOpen": "jawOpen", "eyeBlinkLeft": "eyeBlink_L", "mouthSmileRight": "mouthSmile_R"}
SIZE, HEIGHT_MM, CENTRE, YAW, LABEL = 300, 235.0, np.array([[0.0, -25, 0]]), 15.0, 26


def tile(V: np.ndarray, head: MorphableModel, label: str) -> np.ndarray:
    turned = ScaledOrthographicCamera.look(yaw=YAW).rotation
    scale = SIZE / HEIGHT_MM
    middle = ScaledOrthographicCamera(scale, turned, np.zeros(2)).project(CENTRE)[0]
    camera = ScaledOrthographicCamera(scale, turned, np.full(2, SIZE / 2) - middle)
    picture = np.full((SIZE + LABEL, SIZE, 3), 255, np.uint8)
    picture[:SIZE] = render_mesh(Surface(V, head.faces), camera, SIZE, shading="clay")
    place = (8, SIZE + 18)
    cv2.putText(picture, label, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA)
    return picture


def figure(head: MorphableModel, rig: Rig) -> np.ndarray:
    ours, theirs = [], []
    for name, own in NAMES.items():
        ours.append(tile(rig.vertices({name: 1.0} if name else None), head, f"ours: {name}" if name else "neutral"))
        shape = head.expression[head.expression_index(own)] if own else 0.0
        theirs.append(tile(head.mean + shape, head, f"its own: {own}" if own else "neutral"))
    return np.vstack([np.hstack(ours), np.hstack(theirs)])


def main() -> None:
    head = load_ict_facekit(sys.argv[1])
    out = Path(sys.argv[2]) if len(sys.argv) > 2 else HERE / "foreign_rig.jpg"
    write_image(out, figure(head, rig_mesh(head.mean, head.faces, head.landmarks)))


if __name__ == "__main__":
    main()
