"""Pictures of random faces with exact landmarks and masks, drawn from the template: see `render_face`."""

from renders.render_face import Part, Render, drawn, random_scene, render_face

__all__ = ["Part", "Render", "drawn", "random_scene", "render_face"]
