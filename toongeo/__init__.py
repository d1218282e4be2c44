"""One portrait in; a textured, rigged, animatable 3D face out.

The stages, in the order in which :func:`make_avatar` calls them:

1. :func:`read_image`, and :func:`detect_landmarks` or :func:`read_landmarks` - the picture and its points.
2. :func:`fit_3dmm` - a morphable model posed and shaped by the landmarks (and by the picture: :func:`photometric_fit`).
3. :func:`parse_face`, :func:`snap_eyes` - the parts of the picture, and eye landmarks that lie on the lids.
4. :func:`align_face` (by :func:`laplacian_align`), :func:`fit_cranium` - the mesh deformed onto the landmarks, and its
   skull lowered to the head that is drawn.
5. :func:`build_rig` (by :func:`deformation_transfer`) - 46 FACS expressions for this face; :func:`fit_mouth` - lips
   that meet and do not cross, teeth that stay behind them.
6. :func:`fit_lids` (by :func:`fit_eyes`, :func:`close_lids`, :func:`keep_lids_outside` ...) - eyeballs and lids in
   contact.
7. :func:`make_room`, :func:`build_hair` - a skull inside the outline of its hair, and the hair as a closed shell.
8. :func:`bake_texture` (with :func:`diffuse_texture`), :func:`bake_eyes` - the picture on the UV atlas.
9. :class:`Avatar` - vertices for any weights, pictures, and files (.glb, .vrm, .usdz, .html, .obj, .ply);
   :func:`load_avatar` reads a .glb back.
10. :class:`LandmarkDriver`, :class:`ArkitDriver` - weights of another face's performance, for any avatar.

A head that was modelled elsewhere gets the expressions from :func:`rig_mesh` (by :func:`nonrigid_register`).
For faces that no morphable model reaches, :func:`fit_caricature` does the work of 2 and 3 in a deformation space, and
:func:`caricature_rig` that of 5 in the manner of the drawing.

Every name is imported when it is first used, so ``import toongeo`` itself costs almost nothing.
"""

from toongeo._lazy import attach

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = attach(__name__, __file__)
