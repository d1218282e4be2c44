"""Parts of the reader of meshes: GLB of any program."""
