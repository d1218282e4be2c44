"""Inner parts of the renderer of films: atlas, light, edges."""
