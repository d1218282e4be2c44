"""The two sheets of the shell."""

__all__: list[str] = []
