"""One portrait and its 68 landmarks in; a textured, rigged, animatable 3D face out.

The stages, in the order in which :func:`make_avatar` calls them:

1. :func:`read_image`, :func:`read_landmarks` - the picture and its points.
2. :func:`fit_3dmm` - a morphable model posed and shaped by the landmarks (and by the picture: :func:`photometric_fit`).
3. :func:`parse_face`, :func:`snap_eyes` - the parts of the picture, and eye landmarks that lie on the lids.
4. :func:`align_face` (by :func:`laplacian_align`) - the mesh deformed onto the landmarks.
5. :func:`build_rig` (by :func:`deformation_transfer`) - 46 FACS expressions for this face; :func:`fit_mouth` - lips
   that meet and do not cross, teeth that stay behind them.
6. :func:`fit_lids` (by :func:`fit_eyes`, :func:`close_lids`, :func:`clear_lids` ...) - eyeballs and lids in contact.
7. :func:`bake_texture` (with :func:`diffuse_texture`), :func:`bake_eyes` - the picture on the UV atlas.
8. :class:`Avatar` - vertices for any weights, pictures, and files (.glb, .vrm, .usdz, .html, .obj, .ply);
   :func:`load_avatar` reads a .glb back.
9. :class:`LandmarkDriver`, :class:`ArkitDriver` - weights of another face's performance, for any avatar.

A head that was modelled elsewhere gets the expressions from :func:`rig_mesh` (by :func:`nonrigid_register`).
For faces that no morphable model reaches, :func:`fit_caricature` does the work of 2 and 3 in a deformation space, and
:func:`caricature_rig` that of 5 in the manner of the drawing.

Every name is imported when it is first used, so ``import toongeo`` itself costs almost nothing.
"""

from toongeo._lazy import attach

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = attach(
    __name__,
    {
        "Avatar": "avatar",
        "load_avatar": "load_avatar",
        "make_avatar": "make_avatar",
        "read_image": "io",
        "read_landmarks": "io",
        "write_landmarks": "io",
        "default_model": "model",
        "expression_weights": "model",
        "preset": "model",
        "MorphableModel": "model",
        "ScaledOrthographicCamera": "render",
        "PerspectiveCamera": "render",
        "render_mesh": "render",
        "laplacian_align": "geometry",
        "LaplacianAligner": "geometry",
        "deformation_transfer": "geometry",
        "DeformationTransfer": "geometry",
        "ArkitDriver": "driving",
        "LandmarkDriver": "driving",
        "Take": "driving",
        "send_weights": "driving",
        "ExpressionDriver": "protocols",
        "nonrigid_register": "geometry",
        "RegisteredMesh": "geometry",
        "Coefficients": "protocols",
        "fit_3dmm": "pipeline",
        "RidgeRegressor": "pipeline",
        "train_ridge_regressor": "pipeline",
        "FaceFit": "pipeline",
        "FitOptions": "pipeline",
        "adjust_coefficients": "pipeline",
        "photometric_fit": "pipeline",
        "PhotometricOptions": "pipeline",
        "rendered_picture": "pipeline",
        "residual_map": "pipeline",
        "parse_face": "pipeline",
        "find_hair": "pipeline",
        "HairMask": "protocols",
        "HairFinder": "protocols",
        "ClassicalParser": "pipeline",
        "FaceParse": "protocols",
        "FaceLabel": "protocols",
        "snap_eyes": "pipeline",
        "align_face": "pipeline",
        "AlignedFace": "pipeline",
        "diffuse_texture": "pipeline",
        "bake_texture": "pipeline",
        "texture_coordinates": "pipeline",
        "bake_eyes": "pipeline",
        "neutral_face": "pipeline",
        "build_rig": "pipeline",
        "Rig": "pipeline",
        "Animator": "pipeline",
        "rig_mesh": "pipeline",
        "fit_eyes": "pipeline",
        "fit_lids": "pipeline",
        "close_lids": "pipeline",
        "clear_lids": "pipeline",
        "fit_mouth": "pipeline",
        "Eyes": "pipeline",
        "CaricatureFit": "caricature",
        "CaricatureOptions": "caricature",
        "DeformationSpace": "caricature",
        "FaceSpace": "caricature",
        "caricature_surface": "caricature",
        "exaggerate": "caricature",
        "face_space": "caricature",
        "fit_caricature": "caricature",
        "BlendshapeWeights": "caricature",
        "PartMapper": "caricature",
        "caricature_rig": "caricature",
        "initial_blendshapes": "caricature",
        "optimize_blendshapes": "caricature",
        "weights_of_expression": "caricature",
        "LandmarkMapper": "protocols",
        "edit_expression": "edit_expression",
        "ExpressionEditor": "expression_editor",
        "ClassicalTextureGenerator": "caricature",
        "TextureGenerator": "protocols",
        "TextureGeometry": "protocols",
        "attention_map": "caricature",
        "compose_texture": "caricature",
    },
)
