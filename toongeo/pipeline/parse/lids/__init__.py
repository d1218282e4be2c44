"""Lids in the picture."""
