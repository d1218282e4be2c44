"""Public names in the prose, written as code, are links to their page of the API; and the way back."""

import ast
import re
from functools import cache

from docutils import nodes
from repository_links import ROOT
from sphinx.util.nodes import make_refnode

__all__ = ["setup"]

_NAME = re.compile(r"(?:tg\.|toongeo\.)?([A-Za-z_]\w*(?:\.\w+)*)(?:\(.*\))?", re.DOTALL)
_IN_CODE = re.compile(r"\b(?:tg|toongeo)\.(\w+)")
_SHOWN = 8  # links from a name back to pages that use it; more would be a list that nobody reads


def _page(domain, name):
    return next((domain.objects[n] for n in (f"toongeo.{name}", name) if n in domain.objects), None)


def _around(node):
    while node := node.parent:
        yield node


def _link(app, doctree, docname) -> None:
    domain = app.env.get_domain("py")
    for literal in list(doctree.findall(nodes.literal)):
        if any(isinstance(around, nodes.reference | nodes.title) for around in _around(literal)):
            continue
        match = _NAME.fullmatch(literal.astext())
        there = match and _page(domain, match[1])
        if there and there.docname != docname:
            literal.replace_self(make_refnode(app.builder, docname, there.docname, there.node_id, literal.deepcopy()))


def _remember(app, doctree) -> None:
    """Which names a page of prose uses, in its text and in its code."""
    docname = app.env.docname
    if docname.startswith(("api/", "project/")) or docname in ("index", "api/index"):
        return
    used = set()
    for node in doctree.findall(nodes.literal):
        if match := _NAME.fullmatch(node.astext()):
            used.add(match[1])
    for node in doctree.findall(nodes.literal_block):
        used |= set(_IN_CODE.findall(node.astext()))
    _uses(app.env)[docname] = used


def _uses(env):
    if not hasattr(env, "toongeo_uses"):
        env.toongeo_uses = {}
    return env.toongeo_uses


def _back(app, doctree, docname) -> None:
    """At the end of a name's page, the pages that use it."""
    if not docname.startswith("api/toongeo."):
        return
    name = docname.rpartition(".")[2]
    pages = sorted(page for page, used in _uses(app.env).items() if name in used)[:_SHOWN]
    if not pages:
        return
    items = nodes.bullet_list()
    for page in pages:
        title = app.env.titles[page].astext()
        link = nodes.reference("", title, internal=True, refuri=app.builder.get_relative_uri(docname, page))
        items += nodes.list_item("", nodes.paragraph("", "", link))
    section = next(iter(doctree.findall(nodes.section)), doctree)
    section += nodes.rubric("", "Used in")
    section += items


def _merge(app, env, docnames, other) -> None:
    _uses(env).update({page: used for page, used in _uses(other).items() if page in docnames})


def _forget(app, env, docname) -> None:
    _uses(env).pop(docname, None)


@cache
def _defined() -> frozenset[str]:
    """Every function, class, method and module of the package, by its last name."""
    found = set()
    for path in (ROOT / "toongeo").rglob("*.py"):
        found |= {path.stem, path.parent.name}
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                found.add(node.name)
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                found.add(node.target.id)
            elif isinstance(node, ast.Assign):
                found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return frozenset(found)


def _resolve(app, env, node, contnode):
    """Names that docstrings mention from inside: public ones by another path, and inner ones, which stay code.

    A word in single backticks may be any word; a role must name something that is there.
    """
    target = node.get("reftarget", "")
    if node.get("refdomain") != "py":
        return None
    there = _page(env.get_domain("py"), target.removeprefix("toongeo.")) or _page(
        env.get_domain("py"), target.rpartition(".")[2]
    )
    if there is not None:
        return make_refnode(app.builder, node["refdoc"], there.docname, there.node_id, contnode)
    known = node.get("reftype") == "obj" or target.rpartition(".")[2] in _defined()
    return contnode if known else None


def setup(app):
    app.connect("doctree-read", _remember)
    app.connect("env-merge-info", _merge)
    app.connect("env-purge-doc", _forget)
    app.connect("doctree-resolved", _link)
    app.connect("doctree-resolved", _back)
    app.connect("missing-reference", _resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True, "env_version": 1}
