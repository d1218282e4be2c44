"""Hair as a closed shell about the head, from the pixels of one picture that show it."""

__all__: list[str] = []
