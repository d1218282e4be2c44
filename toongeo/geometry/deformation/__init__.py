"""Parts of Laplacian alignment and deformation transfer."""
