"""Camera, rasterizer, spherical-harmonics light and shading; knows no faces."""

from toongeo.render.camera import ScaledOrthographicCamera
from toongeo.render.interpolate import interpolate
from toongeo.render.perspective_camera import PerspectiveCamera
from toongeo.render.rasterize import Fragments, rasterize
from toongeo.render.render_mesh import render_mesh
from toongeo.render.sample_image import sample_image
from toongeo.render.spherical_harmonics import irradiance, sh_basis
from toongeo.render.srgb import linear_to_srgb, srgb_to_linear
from toongeo.render.studio_light import studio_light
from toongeo.render.surface import Surface
from toongeo.render.uv_to_px import uv_to_px

__all__ = [
    "Fragments",
    "PerspectiveCamera",
    "ScaledOrthographicCamera",
    "Surface",
    "interpolate",
    "irradiance",
    "linear_to_srgb",
    "rasterize",
    "render_mesh",
    "sample_image",
    "sh_basis",
    "srgb_to_linear",
    "studio_light",
    "uv_to_px",
]
