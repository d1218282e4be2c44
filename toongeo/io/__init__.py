"""Files: pictures, landmarks, and meshes as GLB, VRM, OBJ, PLY and USDZ.

Axes and units are converted here and nowhere else. Every writer is atomic: on any error nothing
half-written remains.
"""

from toongeo.io.atomic_write import atomic_write
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.io.encode_glb import encode_glb
from toongeo.io.encode_image import encode_image
from toongeo.io.glb_scene import glb_scene
from toongeo.io.landmark_array import landmark_array
from toongeo.io.page_html import page_html
from toongeo.io.read_glb import GlbDocument, read_glb
from toongeo.io.read_image import read_image
from toongeo.io.read_landmarks import read_landmarks
from toongeo.io.read_mesh_landmarks import read_mesh_landmarks
from toongeo.io.read_obj import ObjData, read_obj
from toongeo.io.scene import Scene, SceneAnimation, SceneMesh
from toongeo.io.split_seams import split_seams
from toongeo.io.vrm_meta import VrmMeta
from toongeo.io.write_glb import write_glb
from toongeo.io.write_image import write_image
from toongeo.io.write_landmarks import write_landmarks
from toongeo.io.write_obj import write_obj
from toongeo.io.write_obj_sequence import write_obj_sequence
from toongeo.io.write_ply import write_ply
from toongeo.io.write_usdz import write_usdz
from toongeo.io.write_vrm import write_vrm

__all__ = [
    "GlbDocument",
    "ObjData",
    "Scene",
    "SceneAnimation",
    "SceneMesh",
    "VrmMeta",
    "atomic_write",
    "check_image",
    "check_landmarks",
    "encode_glb",
    "encode_image",
    "glb_scene",
    "landmark_array",
    "page_html",
    "read_glb",
    "read_image",
    "read_landmarks",
    "read_mesh_landmarks",
    "read_obj",
    "split_seams",
    "write_glb",
    "write_image",
    "write_landmarks",
    "write_obj",
    "write_obj_sequence",
    "write_ply",
    "write_usdz",
    "write_vrm",
]
