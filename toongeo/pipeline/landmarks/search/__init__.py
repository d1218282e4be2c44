"""Parts of the landmark detector: boxes, the cascade, and what tells faces from clutter."""
