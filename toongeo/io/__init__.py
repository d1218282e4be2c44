"""Files: pictures, landmarks, and meshes as GLB, OBJ and PLY.

Axes and units are converted here and nowhere else. Every writer is atomic: on any error nothing
half-written remains.
"""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(
    __name__,
    {
        "atomic_write": "atomic_write",
        "check_landmarks": "check_landmarks",
        "encode_glb": "encode_glb",
        "encode_image": "encode_image",
        "glb_scene": "glb_scene",
        "GlbDocument": "read_glb",
        "ObjData": "read_obj",
        "read_glb": "read_glb",
        "read_image": "read_image",
        "read_landmarks": "read_landmarks",
        "read_obj": "read_obj",
        "Scene": "scene",
        "SceneAnimation": "scene",
        "SceneMesh": "scene",
        "split_seams": "split_seams",
        "write_glb": "write_glb",
        "write_image": "write_image",
        "write_landmarks": "write_landmarks",
        "write_obj": "write_obj",
        "write_ply": "write_ply",
    },
)
