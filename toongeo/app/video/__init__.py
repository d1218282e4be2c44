"""Films: frames on all cores, encoders, sound."""
