"""``toongeo bench score``: which face of the pairs people preferred."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from pathlib import Path

from scipy.stats import binomtest

from toongeo.app.bench.blind_sheets import QUESTIONS
from toongeo.app.bench.pair_sheets import FITTED
from toongeo.reading.check_file import file_bytes
from toongeo.reading.decoded import decoded

__all__ = ["Preference", "preferences_text", "score_answers"]

_COLUMNS = ("picture", "question", "answer")


@dataclass(frozen=True)
class Preference:
    """Answers to one question.

    Attributes
    ----------
    question : str
    first, second : int
        How often each side was preferred.
    p_value : float
        Of so uneven a split or a more uneven one, if either were chosen with probability 1/2 (exact, two-sided); 1
        without answers. The test takes the answers for independent, which those of several people to one sheet are
        not quite.
    sides : (str, str)
        What they are called: ours and baseline, or new and old.
    """

    question: str
    first: int
    second: int
    p_value: float
    sides: tuple[str, str] = FITTED


def score_answers(answers: Path, key: Path) -> list[Preference]:
    """Count the answers, with the key that tells which face is whose.

    Parameters
    ----------
    answers : Path
        CSV with the columns picture, question and answer (A or B; empty: not answered). Forms of several people may
        stand beneath each other in it.
    key : Path
        ``.key.json`` as `pair_sheets` or `render_pairs` wrote it.

    Returns
    -------
    list of Preference
        For each question.

    Raises
    ------
    ValueError
        If a file is not of its kind, or a line names an unknown picture, question or answer, or nothing is answered.
    OSError
        If a file cannot be read.
    """
    names, sides = _sides(key)
    counts = {question: dict.fromkeys(names, 0) for question in QUESTIONS}
    for where, picture, question, answer in _answered(answers):
        for name, value, known in (
            ("picture", picture, sides), ("question", question, counts), ("answer", answer, ("A", "B")),
        ):  # fmt: skip
            if value not in known:
                raise ValueError(f"answers: expected {name} one of {', '.join(known)}, got {value!r} in {where}")
        counts[question][sides[picture][answer]] += 1
    if not any(sum(count.values()) for count in counts.values()):
        raise ValueError(f"answers: expected at least one answer A or B, got none in {answers}")
    return [_preference(question, count[names[0]], count[names[1]], names) for question, count in counts.items()]


def preferences_text(preferences: list[Preference]) -> str:
    """A line a question."""
    first, second = preferences[0].sides
    lines = [f"{'question':<12}{first:>6}{second:>10}{'share':>9}{'p':>10}"]
    for found in preferences:
        count = found.first + found.second
        share = f"{100 * found.first / count:.1f} %" if count else "-"
        lines.append(f"{found.question:<12}{found.first:>6}{found.second:>10}{share:>9}{found.p_value:>10.3g}")
    return "\n".join([*lines, f"share: preferred {first}; p: exact two-sided binomial test against 1/2"])


def _preference(question: str, first: int, second: int, sides: tuple[str, str]) -> Preference:
    p_value = float(binomtest(first, first + second).pvalue) if first + second else 1.0
    return Preference(question, first, second, p_value, sides)


def _sides(key: Path) -> tuple[tuple[str, str], dict[str, dict[str, str]]]:
    """The two sides; and sheet -> letter -> side."""
    try:
        content = json.loads(file_bytes(key, argument="key"))
        first, second = content.get("sides", FITTED)
        pairs = {name: {letter: pair[letter] for letter in "AB"} for name, pair in content["pairs"].items()}
    except (ValueError, KeyError, TypeError, AttributeError):
        raise ValueError(f"key: expected the key that `toongeo bench pairs` wrote, got {key}") from None
    if not pairs or any({pair["A"], pair["B"]} != {first, second} for pair in pairs.values()):
        raise ValueError(f"key: expected {first} and {second} for the letters of each pair, got others in {key}")
    return (first, second), pairs


def _answered(path: Path) -> list[tuple[str, str, str, str]]:
    """Where it stands, picture, question and answer of each line with an answer."""
    try:
        rows = list(csv.reader(decoded(file_bytes(path, argument="answers")).splitlines()))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"answers: expected a CSV file, but {path} is not ({error})") from error
    if not rows or tuple(cell.strip() for cell in rows[0]) != _COLUMNS:
        got = ",".join(rows[0]) if rows else "nothing"
        raise ValueError(f"answers: expected the heading {','.join(_COLUMNS)}, got {got[:60]!r} in {path}")
    found = []
    for number, row in enumerate(rows[1:], start=2):
        cells, where = [cell.strip() for cell in row], f"line {number} of {path}"
        if not any(cells) or tuple(cells) == _COLUMNS:  # an empty line, or the heading of another form
            continue
        if len(cells) != len(_COLUMNS):
            raise ValueError(f"answers: expected {len(_COLUMNS)} cells, got {len(cells)} in {where}")
        if cells[2]:
            found.append((where, cells[0], cells[1].lower(), cells[2].upper()))
    return found
