"""Fine stage: the coarse face deformed onto the landmarks."""
