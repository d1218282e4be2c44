"""Landmarks picked on a mesh, in the browser: ``toongeo model pick`` and ``toongeo landmarks`` of a mesh."""
