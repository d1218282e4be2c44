"""Equations as MathML, which browsers and screen readers know: no script, nothing from the network."""

import contextlib
import re
import unicodedata

from docutils.nodes import SkipNode
from latex2mathml.converter import convert
from sphinx.errors import ExtensionError
from sphinx.util import logging

__all__ = ["setup"]

_logger = logging.getLogger(__name__)
_ALIGNED = re.compile(r"(?<!\\)&|\\\\")
_SURROUNDED = re.compile(r"\\begin\{(\w+)\}.*?\\end\{\1\}", re.DOTALL)
# What the converter knows under another name, or not at all: a gathered column is a matrix in display style.
_RENAMED = {"aligned": "split", "align": "align*", "gathered": "matrix", "gather": "gather*"}
_ENVIRONMENT = re.compile(rf"\\(begin|end)\{{({'|'.join(_RENAMED)})\}}")


# Browsers know alphabets as letters of Unicode, not as a variant of plain ones.
_VARIANT = re.compile(r'<mi mathvariant="(script|bold|double-struck|fraktur)">(\w+)</mi>')


def _letters(text: str, variant: str) -> str:
    def letter(c: str) -> str:
        case = "CAPITAL" if c.isupper() else "SMALL"
        for name in (f"MATHEMATICAL {variant} {case} {c}", f"{variant} {case} {c}", f"MATHEMATICAL {variant} {c}"):
            with contextlib.suppress(KeyError):
                return unicodedata.lookup(name.upper())
        return c

    return "".join(map(letter, text))


def _mathml(latex: str, node, display: str) -> str:
    wide = "gathered" in latex
    latex = _ENVIRONMENT.sub(lambda m: rf"\{m[1]}{{{_RENAMED[m[2]]}}}", latex.strip())
    latex = latex.replace(r"\arg", r"\operatorname{arg}")
    if display == "block" and _ALIGNED.search(_SURROUNDED.sub("", latex)):
        latex = rf"\begin{{split}}{latex}\end{{split}}"
    try:
        found = convert(latex, display=display)
    except Exception as error:
        raise ExtensionError(f"{node.source}: no MathML of {latex!r}: {error!r}") from error
    if wide:
        found = found.replace("<mtable>", '<mtable displaystyle="true">')
    found = _VARIANT.sub(lambda m: f"<mi>{_letters(m[2], m[1])}</mi>", found)
    # What the converter does not know it writes out as it stands.
    if unknown := re.search(r">(?:\\\w+|&)<", found):
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
