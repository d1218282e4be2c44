"""Expressions, eyes and what moves them."""
