"""Training of the landmark detector on renders."""
