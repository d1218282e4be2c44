"""The picture on the face: texture coordinates, baking, diffusion."""
