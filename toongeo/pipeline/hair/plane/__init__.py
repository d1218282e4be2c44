"""The picture's plane in millimetres, and rasters of it."""

__all__: list[str] = []
