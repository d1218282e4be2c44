"""Links between files of the repository, as links between pages of the site."""

import os
import re
from pathlib import Path

__all__ = ["DOCS", "PAGES", "ROOT", "repository_links"]

DOCS = Path(__file__).parents[1]
ROOT = DOCS.parent

# Files outside docs/ that are pages of the site.
PAGES = {
    "README.md": "docs/index.md",
    "CHANGELOG.md": "docs/project/changelog.md",
    "CONTRIBUTING.md": "docs/project/contributing.md",
    "benchmarks/RESULTS.md": "docs/project/results.md",
    "data_templates/LICENSE.md": "docs/project/licences.md",
    "data_templates/README.md": "docs/project/template.md",
    "examples/README.md": "docs/learn/index.md",
    "examples/portraits/README.md": "docs/project/pictures.md",
}

# [text](target) and [text](target "title"); the text may hold brackets of one level, as images in links have.
_LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\](?:\([^)]*\))?)*)\]\(([^()\s]+)((?:\s+\"[^\"]*\")?)\)")


def repository_links(text: str, source: str, page: str) -> str:
    """Markdown whose relative links hold from another place.

    Parameters
    ----------
    text : str
    source, page : str
        Where the text stands and where it is shown, from the root of the repository. What is a page of the site is
        linked as that page, what is not there any more loses its link.
    """

    def replaced(match):
        picture, label, target, title = match.groups()
        label = repository_links(label, source, page)
        if re.match(r"[a-z]+:|#|/", target) or target.startswith("<"):
            return f"{picture}[{label}]({target}{title})"
        path, _, anchor = target.partition("#")
        there = os.path.normpath(os.path.join(os.path.dirname(source), path))
        there = PAGES.get(there, there)
        if there.startswith("examples/") and there.endswith(".ipynb"):
            there = f"docs/learn/{Path(there).name}"
        elif (ROOT / there).is_dir():
            there = PAGES.get(f"{there}/README.md", "")
        if not there.startswith("docs/") and not (ROOT / there).is_file():
            return label
        near = os.path.relpath(there, os.path.dirname(page))
        return f"{picture}[{label}]({near}{'#' + anchor if anchor else ''}{title})"

    return _LINK.sub(replaced, text)
