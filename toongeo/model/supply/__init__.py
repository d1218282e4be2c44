"""What a model from elsewhere lacks, made for it."""
