"""Avatars in notebooks."""
