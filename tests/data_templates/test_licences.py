"""Every file of numbers says where it comes from."""

import re

from tests.conftest import ROOT

LICENCE = ROOT / "data_templates" / "LICENSE.md"
NUMBERS = {".csv", ".npz", ".npy", ".json", ".bin"}
PROGRAMS = {"package.json", "package-lock.json", "tsconfig.json"}  # what npm installs


def listed() -> dict[str, list[str]]:
    """The cells of the table's rows by the path in the first one."""
    rows = re.findall(r"^\| `((?:data_templates|toongeo)/[^`]+)` \|(.+)\|$", LICENCE.read_text(encoding="utf-8"), re.M)
    return {path: [cell.strip() for cell in cells.split("|")] for path, cells in rows}


def files() -> set[str]:
    folders = ROOT / "toongeo", ROOT / "data_templates"
    every = (path for folder in folders for path in folder.rglob("*") if "node_modules" not in path.parts)
    return {str(path.relative_to(ROOT).as_posix()) for path in every if is_numbers(path)}


def is_numbers(path) -> bool:
    return path.suffix in NUMBERS and path.name not in PROGRAMS and not path.name.startswith(".")


def test_every_file_of_numbers_has_a_line_and_every_line_a_file():
    assert set(listed()) == files()


def test_each_line_names_source_licence_and_maker():
    for path, cells in listed().items():
        assert len(cells) == 3 and all(cells), path
        assert cells[1].startswith(("CC0", "MIT")), path
        if cells[2] != "by hand":
            (maker,) = re.findall(r"`([^`]+\.py)`", cells[2])
            assert (ROOT / "data_templates" / maker).exists() or (ROOT / maker).exists(), path
