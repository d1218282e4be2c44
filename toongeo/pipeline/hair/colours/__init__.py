"""The texture of the shell."""

__all__: list[str] = []
