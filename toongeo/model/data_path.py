"""Where the files are that travel with the library: the door for everyone above the lowest layer."""

from toongeo._data_path import data_path

__all__ = ["data_path"]
