"""Parts of a GLB."""
