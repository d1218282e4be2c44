"""MediaPipe's 478 points of the largest face of pictures, as JSON: one list or null a picture.

usage: python mediapipe_points.py PICTURE ...   (in an environment with mediapipe==0.10.21, which needs numpy < 2)
"""

import json
import sys

import cv2
import mediapipe


def main() -> None:
    out = []
    with mediapipe.solutions.face_mesh.FaceMesh(static_image_mode=True, refine_landmarks=True) as mesh:
        for path in sys.argv[1:]:
            img = cv2.cvtColor(cv2.imread(path), cv2.COLOR_BGR2RGB)
            found = mesh.process(img).multi_face_landmarks
            size = img.shape[1], img.shape[0]
            points = [[p.x * size[0] - 0.5, p.y * size[1] - 0.5] for p in found[0].landmark] if found else None
            out.append(points)
    print(json.dumps(out))


if __name__ == "__main__":
    main()
