"""Inner parts of the rasterizer: two ways to the nearest face of each pixel."""
