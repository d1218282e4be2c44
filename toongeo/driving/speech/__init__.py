"""Speech as motion: timings of visemes, or the sound alone."""
