"""Readers of landmark files, a format a file."""
