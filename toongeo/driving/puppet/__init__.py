"""Faces of any file, moved by a take."""
