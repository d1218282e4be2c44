"""A table whose first heading is empty tells screen readers that rows begin there."""

from docutils import nodes

__all__ = ["setup"]


def _name_rows(app, doctree) -> None:
    for head in doctree.findall(nodes.thead):
        for entry in head.findall(nodes.entry):
            if not entry.astext().strip():
                words = nodes.inline("", "row", classes=["visually-hidden"])
                entry.children = [nodes.paragraph("", "", words)]
                entry.setup_child(entry.children[0])


def setup(app):
    app.connect("doctree-read", _name_rows)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
