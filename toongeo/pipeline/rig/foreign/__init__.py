"""Expressions for heads that were modelled elsewhere."""
