"""Camera, rasterizer, spherical-harmonics light and shading; knows no faces."""

from toongeo._lazy import attach

__getattr__, __dir__, __all__ = attach(
    __name__,
    {
        "Fragments": "rasterize",
        "ScaledOrthographicCamera": "camera",
        "Surface": "surface",
        "interpolate": "interpolate",
        "irradiance": "spherical_harmonics",
        "linear_to_srgb": "srgb",
        "rasterize": "rasterize",
        "render_mesh": "render_mesh",
        "sample_image": "sample_image",
        "sh_basis": "spherical_harmonics",
        "srgb_to_linear": "srgb",
        "studio_light": "studio_light",
        "uv_to_px": "uv_to_px",
    },
)
