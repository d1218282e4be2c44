"""Lines where an artist draws them: along the landmarks."""
