"""Coarse stage: a morphable model fitted to the landmarks."""
