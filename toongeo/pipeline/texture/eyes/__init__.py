"""Irises found in the picture, eyes aimed and painted."""
