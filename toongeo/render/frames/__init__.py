"""Inner parts of the renderer of films: paint, edges, textures."""
