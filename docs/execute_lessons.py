"""Execute the lessons of `examples/` from clean, and write each beside its script as a notebook with outputs.

    python docs/execute_lessons.py [STEM ...]    # all, or 05_fitting ...: writes examples/STEM.ipynb
    python docs/execute_lessons.py --check       # writes nothing; fails where a notebook shows something else

The script `examples/NN_name.py` (percent cells) is the source. What is written depends on it and on what it computes
alone: no time stamps, cell ids from the cells' text, no version of Python. A cell that raises, warns or prints a path
of this machine fails. The same versions of packages give the same bytes; ``--check`` allows other ones the last digits
of numbers, and looks at text, not at pictures.
"""

import argparse
import ast
import base64
import concurrent.futures
import hashlib
import io
import itertools
import json
import os
import re
import sys
import time
from pathlib import Path

import jupytext
import nbformat
import numpy as np
from nbclient import NotebookClient
from PIL import Image

__all__ = ["PRIVATE", "caption_of", "checked", "code_digest", "executed", "main", "paired", "same_text", "shows"]

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
# Absolute paths and addresses of objects: neither means anything to a reader. Of a Windows path the drive counts with
# the backslash (two in JSON and in a repr) and a name; `class C:` before the end of a line is `C:\n` in JSON, and none.
PRIVATE = re.compile(
    r"(?<![\w./])/(?:home|root|tmp|usr|opt|var|Users|private|mnt|srv|work|workspace)/|site-packages"
    r"|\b[A-Z]:\\{1,2}(?![nrt]\b)\w|0x[0-9a-f]{6,}"
)
_NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_CAPTION = re.compile(r"\*?Figure[^:]*: *(.+?)\*?", re.DOTALL)
# A cell that takes longer is broken: a whole lesson takes less than 30 s on one core that it has to itself.
_CELL_SECONDS = 600
# Asked after the last cell, and of no notebook.
_NUMBERS = "import json\nprint(json.dumps({name: float(x) for name, x in globals().get('numbers', {}).items()}))"
_METADATA = {
    "jupytext": {"text_representation": {"extension": ".py", "format_name": "percent"}},
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {
        "file_extension": ".py",
        "mimetype": "text/x-python",
        "name": "python",
        "pygments_lexer": "ipython3",
    },
}


def paired(script: Path) -> nbformat.NotebookNode:
    """The script as a notebook without outputs; ids of cells follow from their text."""
    notebook = jupytext.read(script, fmt="py:percent")
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    notebook.metadata = nbformat.from_dict(_METADATA | {"toongeo": {"executed": code_digest(notebook)}})
    seen: dict[str, int] = {}
    for cell in notebook.cells:
        digest = hashlib.sha256(f"{cell.cell_type}\n{cell.source}".encode()).hexdigest()[:8]
        seen[digest] = seen.get(digest, 0) + 1
        cell.id = f"{digest}-{seen[digest]}"
        cell.metadata = nbformat.from_dict({})
    return notebook


def code_digest(notebook: nbformat.NotebookNode) -> str:
    """Hash of all code of a notebook, in order: outputs that were made by other code are stale."""
    code = "\n# %%\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    return hashlib.sha256(code.encode()).hexdigest()


def executed(script: Path) -> tuple[nbformat.NotebookNode, dict[str, float]]:
    """The lesson with outputs, executed by a new kernel in its folder, as JupyterLab would, and its `numbers`.

    Raises
    ------
    RuntimeError
        If a cell raises, writes to stderr (as a warning does) or shows a path of this machine.
    """
    os.environ |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONWARNINGS": "default"}
    os.environ |= {"PYTHONHASHSEED": "0", "PYTHONPATH": os.pathsep.join([str(EXAMPLES.parent), *_python_path()])}
    os.environ.pop("MPLBACKEND", None)
    notebook = paired(script)
    notebook.cells.append(nbformat.v4.new_code_cell(_NUMBERS))
    client = NotebookClient(
        notebook,
        timeout=_CELL_SECONDS,
        kernel_name="python3",
        record_timing=False,
        extra_arguments=["--IPKernelApp.log_level=40"],  # errors alone
        resources={"metadata": {"path": str(script.parent)}},
    )
    metadata = notebook.metadata
    client.execute()
    numbers = json.loads(notebook.cells.pop().outputs[0].text)
    notebook.metadata = metadata | nbformat.from_dict(_METADATA)
    for i, cell in enumerate(notebook.cells):
        if cell.cell_type == "code":
            cell.metadata = nbformat.from_dict({})
            cell.outputs = [_tidy(output, caption_of(notebook, i)) for output in _joined(cell.outputs)]
            for output in cell.outputs:
                _check(output, f"{script.stem}, cell {i}")
    nbformat.validate(notebook)
    return notebook, numbers


def checked(script: Path) -> tuple[list[str], dict[str, float]]:
    """What the lesson, executed anew, shows in other words or numbers than its notebook, and its `numbers`."""
    notebook, numbers = executed(script)
    return _differences(nbformat.read(script.with_suffix(".ipynb"), 4), notebook), numbers


def _python_path() -> list[str]:
    return [path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]


def _joined(outputs: list[nbformat.NotebookNode]) -> list[nbformat.NotebookNode]:
    """Text that was printed in pieces, as one; where the pieces break depends on time."""
    result: list[nbformat.NotebookNode] = []
    for output in outputs:
        last = result[-1] if result else None
        if last is not None and output.output_type == last.output_type == "stream" and output.name == last.name:
            last.text += output.text
        else:
            result.append(output)
    return result


def _check(output: nbformat.NotebookNode, where: str) -> None:
    text = _text(output)
    if output.output_type == "stream" and output.name == "stderr":
        raise RuntimeError(f"{where}: wrote to stderr:\n{text}")
    if PRIVATE.search(text):
        raise RuntimeError(f"{where}: shows a path or an address of this machine:\n{text[:2000]}")


def _text(output: nbformat.NotebookNode) -> str:
    if output.output_type == "stream":
        return output.text
    return "\n".join(str(value) for kind, value in sorted(output.get("data", {}).items()) if kind.startswith("text/"))


def _tidy(output: nbformat.NotebookNode, caption: str | None) -> nbformat.NotebookNode:
    """A figure with a palette where that is smaller, and with the caption beside it as its alternative text."""
    picture = output.get("data", {}).get("image/png")
    if picture is not None:
        output.data["image/png"] = _small_png(picture)
        if caption is not None:
            output.data["text/plain"] = caption
            output.metadata["image/png"] = output.metadata.get("image/png", {}) | {"alt": caption}
    return output


def _small_png(encoded: str) -> str:
    """A PNG in base64 without what its writer tells of itself; with 256 colours where that is smaller."""
    picture = Image.open(io.BytesIO(base64.b64decode(encoded))).convert("RGB")
    files = []
    for kept in (picture, picture.quantize(256, dither=Image.Dither.FLOYDSTEINBERG)):
        stream = io.BytesIO()
        kept.save(stream, "png", optimize=True)
        files.append(stream.getvalue())
    return base64.b64encode(min(files, key=len)).decode() + "\n"


def caption_of(notebook: nbformat.NotebookNode, i: int) -> str | None:
    """What a paragraph ``*Figure: ...*`` says in the markdown cell after cell i, or before it; None without one."""
    for j in (i + 1, i - 1):
        if 0 <= j < len(notebook.cells) and notebook.cells[j].cell_type == "markdown":
            for paragraph in notebook.cells[j].source.split("\n\n"):
                if found := _CAPTION.fullmatch(paragraph.strip()):
                    return " ".join(found[1].split())
    return None


def shows(source: str) -> set[str]:
    """Which outputs code must have: ``"text"`` if it prints, ``"picture"`` if it calls ``plt.show()``."""
    calls = {
        ast.unparse(statement.value.func)
        for statement in ast.parse(source).body
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call)
    }
    return {kind for kind, call in (("text", "print"), ("picture", "plt.show")) if call in calls}


def same_text(a: str, b: str) -> bool:
    """Whether two outputs say the same: words to the letter, numbers within 2 % or the last digit they show."""
    if _NUMBER.sub("#", a) != _NUMBER.sub("#", b):
        return False
    for x, y in zip(_NUMBER.findall(a), _NUMBER.findall(b), strict=True):
        places = len(x.partition(".")[2].partition("e")[0])
        digit = 10.0**-places if "e" not in x else 0.0
        if not np.isclose(float(x.replace("−", "-")), float(y.replace("−", "-")), rtol=0.02, atol=1.5 * digit):
            return False
    return True


def _differences(old: nbformat.NotebookNode, new: nbformat.NotebookNode) -> list[str]:
    """What a fresh execution shows in other words or numbers than the notebook that is kept."""
    result = []
    for i, (a, b) in enumerate(itertools.zip_longest(old.cells, new.cells)):
        if a is None or b is None or a.source != b.source:
            return [*result, f"cell {i}: the notebook is not that of the script"]
        x, y = ("\n".join(map(_text, cell.get("outputs", []))) for cell in (a, b))
        if not same_text(x, y):
            result.append(f"cell {i}: kept\n{x}\nnow\n{y}")
    return result


def _lesson(script: Path, check: bool) -> tuple[str, float, list[str]]:
    start = time.perf_counter()
    faults: list[str] = []
    if check:
        faults, _ = checked(script)
    else:
        content = nbformat.writes(executed(script)[0]) + "\n"
        script.with_suffix(".ipynb").write_text(content, encoding="utf-8", newline="\n")
    return script.stem, time.perf_counter() - start, faults


def main(arguments: list[str] | None = None) -> int:
    """Command line; 1 if a lesson raised, warned or, with ``--check``, shows something else than its notebook."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stems", nargs="*", help="lessons, as 05_fitting or 05; all without")
    parser.add_argument("--check", action="store_true", help="write nothing; compare with the notebooks that are kept")
    parser.add_argument("--jobs", type=int, default=1, help="lessons at the same time")
    options = parser.parse_args(arguments)
    scripts = sorted(EXAMPLES.glob("[0-9][0-9]_*.py"))
    if options.stems:
        scripts = [script for script in scripts if script.stem.startswith(tuple(options.stems))]
    failed = 0
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        for script, job in [(script, pool.submit(_lesson, script, options.check)) for script in scripts]:
            try:
                stem, seconds, faults = job.result()
            except Exception as error:
                stem, seconds, faults = script.stem, float("nan"), [str(error)]
            failed += bool(faults)
            print(f"{stem:32s} {seconds:6.1f} s", *faults, sep="\n  " if faults else "", flush=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
