"""Pages made of files that stand elsewhere in the repository: the changelog, results, licences and notebooks."""

import json
from pathlib import Path

from repository_links import DOCS, PAGES, ROOT, repository_links

__all__ = ["gathered_pages", "setup"]


def gathered_pages(app=None) -> None:
    """Write ``docs/project/*.md`` and ``docs/learn/*.ipynb``; a page that has not changed keeps its date."""
    for source, page in PAGES.items():
        if page.startswith("docs/project/") and (ROOT / source).is_file():
            text = (ROOT / source).read_text(encoding="utf-8")
            _write(ROOT / page, _one_title(repository_links(text, source, page)))
    notebooks = sorted((ROOT / "examples").glob("[0-9][0-9]_*.ipynb"))
    for notebook in notebooks:
        _write(DOCS / "learn" / notebook.name, _lesson(notebook))
    for stale in set((DOCS / "learn").glob("*.ipynb")) - {DOCS / "learn" / path.name for path in notebooks}:
        stale.unlink()


def _one_title(text: str) -> str:
    """A licence that is quoted with its own title becomes a section."""
    lines, titles, fenced = text.split("\n"), 0, False
    for k, line in enumerate(lines):
        fenced ^= line.startswith("```")
        if line.startswith("# ") and not fenced:
            titles += 1
            lines[k] = line if titles == 1 else f"#{line}"
    return "\n".join(lines)


def _lesson(notebook: Path) -> str:
    content = json.loads(notebook.read_text(encoding="utf-8"))
    for cell in content["cells"]:
        if cell["cell_type"] == "markdown":
            text = repository_links("".join(cell["source"]), f"examples/{notebook.name}", f"docs/learn/{notebook.name}")
            cell["source"] = text.splitlines(keepends=True)
    return json.dumps(content, indent=1, ensure_ascii=False)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _relink(app, docname, source) -> None:
    """Files of docs/ are read on a code host too, where they link to files that are pages elsewhere here."""
    if (DOCS / f"{docname}.md").is_file():
        source[0] = repository_links(source[0], f"docs/{docname}.md", f"docs/{docname}.md")


def setup(app):
    app.connect("builder-inited", gathered_pages)
    app.connect("source-read", _relink)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
