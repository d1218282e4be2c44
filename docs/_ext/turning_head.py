"""The head on the first page: ``Avatar.save("face.html")`` of a bundled picture, made when the site is built."""

from repository_links import DOCS, ROOT

__all__ = ["setup", "turning_head"]

_PICTURE = ROOT / "examples" / "portraits" / "moustache_man"
_PAGE = DOCS / "_static" / "face.html"


def turning_head(app=None) -> None:
    """Write ``docs/_static/face.html`` if it is not there."""
    if not _PAGE.exists():
        import toongeo as tg

        img = tg.read_image(_PICTURE.with_suffix(".png"))
        landmarks = tg.read_landmarks(_PICTURE.with_suffix(".pts"))
        tg.make_avatar(img, landmarks).save(_PAGE)


def setup(app):
    app.connect("builder-inited", turning_head)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
