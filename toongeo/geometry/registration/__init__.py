"""Parts of nonrigid registration."""
