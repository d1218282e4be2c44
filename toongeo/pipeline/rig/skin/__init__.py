"""Skin that passes through itself."""
