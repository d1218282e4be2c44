"""What of the head gives way to its hair."""

__all__: list[str] = []
