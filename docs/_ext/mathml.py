"""Equations as MathML, which browsers and screen readers know: no script, nothing from the network."""

import re

from docutils.nodes import SkipNode
from latex2mathml.converter import convert
from sphinx.errors import ExtensionError
from sphinx.util import logging

__all__ = ["setup"]

_logger = logging.getLogger(__name__)
_ALIGNED = re.compile(r"(?<!\\)&|\\\\")
# Of amsmath: numbered, and spread over the line, which a browser does by itself.
_STARRED = re.compile(r"\\(begin|end)\{(align|gather|equation)\*?\}")


def _mathml(latex: str, node, display: str) -> str:
    latex = latex.replace(r"\arg", r"\operatorname{arg}")  # which the converter does not know
    latex = _STARRED.sub(lambda m: "" if m[2] == "equation" else rf"\{m[1]}{{aligned}}", latex).strip()
    if display == "block" and _ALIGNED.search(latex) and not latex.startswith(r"\begin"):
        inside = re.sub(r"\\begin\{(\w+)\}.*?\\end\{\1\}", "", latex, flags=re.DOTALL)
        if _ALIGNED.search(inside):
            latex = rf"\begin{{aligned}}{latex}\end{{aligned}}"
    try:
        found = convert(latex, display=display)
    except Exception as error:
        raise ExtensionError(f"{node.source}: no MathML of {latex!r}: {error!r}") from error
    # What the converter does not know it writes out as it stands.
    if unknown := re.search(r">\\\w+<", found):
        _logger.warning("%r is not known in %r", unknown[0][1:-1], latex, location=node)
    return found


def _visit_math(self, node) -> None:
    self.body.append(_mathml(node.astext(), node, "inline"))
    raise SkipNode


def _visit_displaymath(self, node) -> None:
    self.body.append(self.starttag(node, "div", CLASS="equation", tabindex="0"))
    self.body.append(_mathml(node.astext(), node, "block"))
    if node.get("number"):
        self.body.append(f'<span class="eqno">({node["number"]})</span>')
    self.body.append("</div>")
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (_visit_math, None), (_visit_displaymath, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
