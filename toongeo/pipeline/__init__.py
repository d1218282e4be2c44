"""The way of the data, a stage a folder: fit, align, texture, rig."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(
    __name__,
    {
        "fit_3dmm": "fit.fit_3dmm",
        "FaceFit": "fit.face_fit",
        "align_face": "align.align_face",
        "AlignedFace": "align.align_face",
        "diffuse_texture": "texture.diffuse_texture",
        "bake_texture": "texture.bake_texture",
        "build_rig": "rig.build_rig",
        "Rig": "rig.build_rig",
        "fit_eyes": "rig.fit_eyes",
        "Eyes": "rig.fit_eyes",
    },
)
