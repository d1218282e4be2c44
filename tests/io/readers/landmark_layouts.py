"""Landmark files in the exact layouts in which other programs write them."""

import json

import numpy as np

from toongeo.io import SCHEMES
from toongeo.io.landmarks.frontal_layout import frontal_layout
from toongeo.io.landmarks.landmark_schemes import _table

SIZE = (640, 480)
FACE = np.round(320 + 200 * frontal_layout().points, 3)  # of three decimals, as most programs write


def scheme_points(scheme):
    """A face (k, 2) in another scheme: points stand where the table makes the 68 of them, the others at the eyes."""
    points = np.full((SCHEMES[scheme][0], 2), 320.0)
    first, second, share = _table(scheme)
    for k in np.flatnonzero(first >= 0):
        points[first[k]] = FACE[k]
    for middle in np.unique(second[share > 0]):  # of a lid, between two of the 68
        pair = np.flatnonzero((second == middle) & (share > 0))
        points[middle] = FACE[pair].mean(axis=0)
        points[first[pair]] = (3 * FACE[pair] - points[middle]) / 2
    return points


def openface_video(faces):
    heading = "frame, face_id, timestamp, confidence, success, gaze_0_x, " + ", ".join(
        f"{axis}_{k}" for axis in ("x", "y", "X", "Y", "Z") for k in range(68)
    )
    rows = []
    for frame, face_id, success, points in faces:
        numbers = [*points[:, 0], *points[:, 1], *np.zeros(3 * 68)]
        rows.append(
            f"{frame}, {face_id}, {frame / 30:.3f}, 0.980, {success}, 0.1, " + ", ".join(f"{x:.3f}" for x in numbers)
        )
    return "\n".join([heading, *rows]) + "\n"


def openface_picture(faces):
    heading = "face, confidence, gaze_0_x, " + ", ".join(f"{axis}_{k}" for axis in ("x", "y") for k in range(68))
    rows = [f"{k}, 0.9, 0.1, " + ", ".join(map(str, [*points[:, 0], *points[:, 1]])) for k, points in enumerate(faces)]
    return "\n".join([heading, *rows]) + "\n"


def imglab(images):
    boxes = lambda faces: "".join(  # noqa: E731
        "    <box top='90' left='74' width='31' height='31'>\n"
        + "".join(f"      <part name='{k:02d}' x='{x}' y='{y}'/>\n" for k, (x, y) in enumerate(points) if x == x)
        + "    </box>\n"
        for points in faces
    )
    body = "".join(
        f"  <image file='{k}.jpg' width='640' height='480'>\n{boxes(faces)}  </image>\n"
        for k, faces in enumerate(images)
    )
    return (
        "<?xml version='1.0' encoding='ISO-8859-1'?>\n"
        "<?xml-stylesheet type='text/xsl' href='image_metadata_stylesheet.xsl'?>\n"
        "<dataset>\n<name>imglab dataset</name>\n<comment>Created by imglab tool.</comment>\n"
        f"<images>\n{body}</images>\n</dataset>"
    )


def pts(points, newline="\n"):
    rows = newline.join(f"{x:.6f} {y:.6f}" for x, y in points + 1)
    return newline.join(["version: 1", f"n_points:  {len(points)}", "{", rows, "}", ""])


def shares(points):
    return (points + 0.5) / SIZE


def landmark_objects(points):
    """MediaPipe's normalized landmarks."""
    return [{"x": x, "y": y, "z": -0.01, "visibility": 0.0, "presence": 0.0} for x, y in shares(points).tolist()]


def triples(points, score=0.9):
    return [number for x, y in points.tolist() for number in (x, y, score)]


def lines(points, form="{} {}"):
    return "".join(form.format(*row) + "\n" for row in points.tolist())


MESH = scheme_points("mediapipe478")
BODY = scheme_points("wholebody133")
WFLW = scheme_points("wflw98")
YX = FACE[:, ::-1].tolist()

TEXTS = {
    "ibug.pts": (pts(FACE), "ibug68"),
    "windows.pts": (pts(FACE, "\r\n"), "ibug68"),
    "menpo.pts": (
        "version: 1\nn_points: 68\n{\n" + "\n".join(f"{x:.3f} {y:.3f}" for x, y in FACE + 1) + "\n}",
        "ibug68",
    ),
    "inner.pts": (pts(FACE[17:]), "ibug51"),
    "plain.txt": (lines(FACE), "ibug68"),
    "dlib_points.txt": (lines(FACE, "({}, {})"), "ibug68"),
    "dlib_parts.txt": ("".join(f"{k} ({x}, {y})\n" for k, (x, y) in enumerate(FACE.tolist())), "ibug68"),
    "numbered.txt": ("".join(f"{k + 1}\t{x}\t{y}\t0.5\n" for k, (x, y) in enumerate(FACE.tolist())), "ibug68"),
    "depth.csv": ("x,y,z\n" + "".join(f"{x},{y},-3.5\n" for x, y in FACE.tolist()), "ibug68"),
    "pandas.csv": (",x,y,z\n" + "".join(f"{k},{x},{y},0.1\n" for k, (x, y) in enumerate(FACE.tolist())), "ibug68"),
    "mediapipe.csv": (
        "index,x,y,z\n" + "".join(f"{k},{x},{y},0.1\n" for k, (x, y) in enumerate(shares(MESH).tolist())),
        "mediapipe478",
    ),
    "openface.csv": (openface_video([(1, 0, 1, FACE)]), "ibug68"),
    "openface_picture.csv": (openface_picture([FACE, FACE + 9]), "ibug68"),
    "wide.csv": (
        ",".join(f"{axis}{k}" for k in range(68) for axis in "xy") + "\n" + ",".join(map(str, FACE.ravel())),
        "ibug68",
    ),
    "wflw.txt": (
        " ".join(map(str, WFLW.ravel())) + " 182 268 283 396 0 0 0 0 1 0 37--Soccer/37_Soccer_soccer_ball_37_907.jpg\n",
        "wflw98",
    ),
    "lapa.txt": ("106\n" + lines(scheme_points("lapa106")), "lapa106"),
    "imglab.xml": (imglab([[FACE], []]), "ibug68"),
    "list.json": (json.dumps(FACE.tolist()), "ibug68"),
    "object.json": (json.dumps({"landmarks": FACE.tolist(), "image": "a.png"}), "ibug68"),
    "numbers.json": (json.dumps({str(k): point for k, point in enumerate(FACE.tolist())}), "ibug68"),
    "columns.json": (json.dumps({"x": FACE[:, 0].tolist(), "y": FACE[:, 1].tolist()}), "ibug68"),
    "flat.json": (json.dumps(FACE.ravel().tolist()), "ibug68"),
    "face_alignment.json": (json.dumps([FACE.tolist(), (FACE + 5).tolist()]), "ibug68"),
    "mediapipe_js.json": (
        json.dumps(
            {"faceLandmarks": [landmark_objects(MESH)], "faceBlendshapes": [], "facialTransformationMatrixes": []}
        ),
        "mediapipe478",
    ),
    "mediapipe_python.json": (
        json.dumps({"face_landmarks": [landmark_objects(MESH[:468])], "face_blendshapes": []}),
        "mediapipe478",
    ),
    "mediapipe_legacy.json": (json.dumps([{"landmark": landmark_objects(MESH)}]), "mediapipe478"),
    "coco.json": (
        json.dumps(
            {
                "images": [{"id": 7, "file_name": "a.jpg", "width": 640, "height": 480}],
                "annotations": [
                    {"image_id": 7, "bbox": [1, 2, 3, 4], "keypoints": 51 * [0], "face_kpts": triples(FACE)}
                ],
            }
        ),
        "ibug68",
    ),
    "mmpose.json": (
        json.dumps([{"keypoints": BODY.tolist(), "keypoint_scores": 133 * [0.9], "bbox": [[1.0, 2.0, 3.0, 4.0]]}]),
        "wholebody133",
    ),
    "mmpose_video.json": (
        json.dumps({"meta_info": {}, "instance_info": [{"frame_id": 1, "instances": [{"keypoints": BODY.tolist()}]}]}),
        "wholebody133",
    ),
    "openpose.json": (
        json.dumps(
            {
                "version": 1.3,
                "people": [
                    {"pose_keypoints_2d": 75 * [0.5], "face_keypoints_2d": triples(np.vstack([FACE, [[1, 2], [3, 4]]]))}
                ],
            }
        ),
        "openpose70",
    ),
    "landmarker1.ljson": (
        json.dumps(
            {
                "version": 1,
                "groups": [
                    {"label": "jaw", "landmarks": [{"point": p} for p in YX[:17]]},
                    {"label": "inner", "landmarks": [{"point": p} for p in YX[17:]]},
                ],
            }
        ),
        "ibug68",
    ),
    "landmarker2.ljson": (
        json.dumps(
            {
                "version": 2,
                "labels": [{"label": "jaw", "mask": list(range(17))}],
                "landmarks": {"points": YX, "connectivity": [[0, 1]]},
            }
        ),
        "ibug68",
    ),
    "menpo3.ljson": (
        json.dumps({"version": 3, "groups": {"PTS": {"labels": [], "landmarks": {"points": YX, "connectivity": []}}}}),
        "ibug68",
    ),
    "menpo3.json": (
        json.dumps({"version": 3, "groups": {"PTS": {"labels": [], "landmarks": {"points": YX}}}}),
        "ibug68",
    ),
}
ARRAYS = {
    "points.npy": (FACE, "ibug68"),
    "face_alignment.npy": (FACE[None], "ibug68"),
    "face_alignment_3d.npy": (np.dstack([FACE[None], np.ones((1, 68, 1))]).astype(np.float64), "ibug68"),
    "mediapipe.npy": (shares(MESH), "mediapipe478"),
    "mediapipe_3d.npy": (np.c_[shares(MESH[:468]), np.full(468, -0.02)], "mediapipe478"),
    "wholebody.npy": (np.c_[BODY, np.full(133, 0.8)], "wholebody133"),
    "frames.npy": (np.stack([FACE[None], FACE[None] + 1]), "ibug68"),
} | {f"{scheme}.npy": (scheme_points(scheme), scheme) for scheme in SCHEMES}
