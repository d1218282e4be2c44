"""Colour spaces, and cuts that follow colours."""
