"""Teeth and tongue of the picture on those of the head."""
