"""Writers of files; every one is atomic."""
