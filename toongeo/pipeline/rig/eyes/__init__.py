"""Eyeballs, and lids in contact with them."""
