"""What a command raises that found landmarks it does not trust."""

__all__ = ["UnsureLandmarksError"]


class UnsureLandmarksError(Exception):
    """A person should look at the landmarks before work goes on with them."""
