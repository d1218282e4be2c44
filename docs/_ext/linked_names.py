"""Public names in the prose, written as code, are links to their page of the API."""

import re

from docutils import nodes
from sphinx.util.nodes import make_refnode

__all__ = ["setup"]

_NAME = re.compile(r"(?:tg\.|toongeo\.)?([A-Za-z_]\w*(?:\.\w+)*)(?:\(.*\))?", re.DOTALL)


def _link(app, doctree, docname) -> None:
    domain = app.env.get_domain("py")
    for literal in list(doctree.findall(nodes.literal)):
        if isinstance(literal.parent, nodes.reference | nodes.title):
            continue
        match = _NAME.fullmatch(literal.astext())
        name = match and next((n for n in (f"toongeo.{match[1]}", match[1]) if n in domain.objects), None)
        if name and (there := domain.objects[name]).docname != docname:
            literal.replace_self(make_refnode(app.builder, docname, there.docname, there.node_id, literal.deepcopy()))


def _plain(app, env, node, contnode):
    """A word in single backticks of a docstring that names nothing public is only a word."""
    return contnode if node.get("reftype") == "obj" and not node.get("refexplicit") else None


def setup(app):
    app.connect("doctree-resolved", _link)
    app.connect("missing-reference", _plain)
    return {"parallel_read_safe": True}
