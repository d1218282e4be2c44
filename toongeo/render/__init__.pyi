"""The public names, for type checkers and for ``__init__.py``, which imports each when it is first used."""

from toongeo.colour.srgb import linear_to_srgb as linear_to_srgb
from toongeo.colour.srgb import srgb_to_linear as srgb_to_linear
from toongeo.render.camera import ScaledOrthographicCamera as ScaledOrthographicCamera
from toongeo.render.frame_renderer import FrameRenderer as FrameRenderer
from toongeo.render.interpolate import interpolate as interpolate
from toongeo.render.perspective_camera import PerspectiveCamera as PerspectiveCamera
from toongeo.render.rasterize import Fragments as Fragments
from toongeo.render.rasterize import rasterize as rasterize
from toongeo.render.render_mesh import render_mesh as render_mesh
from toongeo.render.sample_image import sample_image as sample_image
from toongeo.render.spherical_harmonics import irradiance as irradiance
from toongeo.render.spherical_harmonics import sh_basis as sh_basis
from toongeo.render.studio_light import studio_light as studio_light
from toongeo.render.surface import Surface as Surface
from toongeo.render.uv_to_px import uv_to_px as uv_to_px
