"""Texts and tables apart, and together again."""

import sys

import pytest

from toongeo.app.bench.results.assemble_results import assemble_results
from toongeo.app.bench.results.bench_all import assemble, bench_all, bench_quick
from toongeo.app.bench.results.record import Record, read_records, write_record
from toongeo.app.bench.results.run_command import filled_command, run_command
from toongeo.app.bench.results.split_results import split_results
from toongeo.app.bench.results.update_records import update_records
from toongeo.app.cli import main

TEXT = """# Results

As they came.

## One, two

`python benchmarks/a.py X`: what it is

| A | B |
|---|---|
| 1 | 2 |

Between.

| C |
|---|
| 3 |

## Three

By hand:

| D |
|:-:|
| 4 |
"""


def records_of(tables):
    return {t.name: Record(t.name, t.command, "2026-01-02", "abc1234", "", "2 cores", t.body) for t in tables}


def test_tables_leave_their_names_in_the_texts():
    sections, tables = split_results(TEXT)
    assert list(sections) == ["head", "one-two", "three"]
    assert sections["one-two"].count("{{one-two-1}}") == 1 and "| 1 |" not in "".join(sections.values())
    assert [(t.name, t.command) for t in tables] == [
        ("one-two-1", "python benchmarks/a.py X"), ("one-two-2", "python benchmarks/a.py X"), ("three-1", ""),
    ]  # fmt: skip
    lines = TEXT.splitlines()
    for table in tables:
        assert "\n".join(lines[table.line - 1 :]).startswith(table.body)


def test_what_was_put_together_comes_apart_into_the_same():
    sections, tables = split_results(TEXT)
    whole = assemble_results(sections, records_of(tables))
    assert whole.count("<sub>Recorded 2026-01-02, at abc1234, 2 cores.</sub>") == 3
    again, same = split_results(whole)
    assert again == sections
    assert [(t.name, t.command, t.body) for t in same] == [(t.name, t.command, t.body) for t in tables]
    assert assemble_results(again, records_of(same)) == whole
    kept = [line for line in whole.splitlines() if not line.startswith("<") and line]
    assert kept == [line for line in TEXT.splitlines() if line]  # nothing is lost


def test_texts_and_records_name_each_other():
    sections, tables = split_results(TEXT)
    records = records_of(tables)
    with pytest.raises(ValueError, match="sections: expected three-1 to be named by a text"):
        assemble_results({"head": sections["head"], "one-two": sections["one-two"]}, records)
    with pytest.raises(ValueError, match="records: expected one called three-1"):
        assemble_results(sections, {name: records[name] for name in ("one-two-1", "one-two-2")})


def test_a_record_is_read_as_it_was_written(tmp_path):
    for record in (
        Record("a", "python x: y", "2026-01-02", "abc", "Python 3", "2 cores, load 3", "| A: B |\n|---|\n\nmore"),
        Record("b", "", "2026-01-02", "", "", "", "text"),
    ):
        write_record(tmp_path, record)
        assert read_records(tmp_path)[record.name] == record
    (tmp_path / "c.md").write_text("no head\n\nbody")
    with pytest.raises(ValueError, match="expected the lines command, date, commit, versions, machine first"):
        read_records(tmp_path)


def test_printed_tables_take_the_place_of_those_with_their_columns():
    records = list(records_of(split_results(TEXT)[1]).values())[:2]
    about = {"date": "2027-01-01", "commit": "new"}
    first, second = update_records(records, "head\n| C |\n|---|\n| 9 |\n", about)
    assert first is records[0] and second.body == "| C |\n|---|\n| 9 |" and second.date == "2027-01-01"
    first, second = update_records(records, "no table", about)
    assert first.body == "```\nno table\n```" and first.commit == "new" and second is records[1]
    assert update_records(records, "", about) == records


def test_tables_with_the_same_columns_keep_their_order():
    records = [Record(name, "x", "2026-01-02", "", "", "", "| A |\n|---|\n| 0 |") for name in "abc"]
    about = {"date": "2027-01-01"}
    updated = update_records(records, "| A |\n|---|\n| 1 |\n\nthen\n\n| A |\n|---|\n| 2 |", about)
    assert [record.body[-5:] for record in updated] == ["| 1 |", "| 2 |", "| 0 |"]
    assert [record.date for record in updated] == ["2027-01-01", "2027-01-01", "2026-01-02"]


def test_commands_with_words_for_data_need_a_path():
    assert filled_command("python benchmarks/a.py CARTOONS x", {"CARTOONS": "/c"}) == "python benchmarks/a.py /c x"
    kept = "PYTHONPATH=.:data python benchmarks/a.py --n 3"
    assert filled_command(kept, {}) == kept
    with pytest.raises(ValueError, match="expected --data CARTOONS=PATH"):
        filled_command("python benchmarks/a.py CARTOONS", {})
    with pytest.raises(ValueError, match="by hand"):
        filled_command("python benchmarks/a.py one|two", {})


@pytest.fixture
def checkout(tmp_path):
    folder = tmp_path / "benchmarks"
    for name in ("sections", "records"):
        (folder / name).mkdir(parents=True)
    (folder / "a.py").write_text("print('| A |\\n|---|\\n| 7 |')")
    (folder / "b.py").write_text("raise SystemExit('no such data')")
    for name, command in (("a-1", "python benchmarks/a.py"), ("b-1", "python benchmarks/b.py")):
        (folder / "sections" / f"0{name}.md").write_text(f"## {name}\n\nIts text.\n\n{{{{{name}}}}}\n")
        write_record(folder / "records", Record(name, command, "2026-01-02", "", "", "", "| A |\n|---|\n| 1 |"))
    (folder / "quick.txt").write_text("python benchmarks/a.py\n")
    return folder


def test_a_run_makes_records_anew_and_keeps_those_that_fail(checkout, capsys):
    assert bench_all(checkout) == ["python benchmarks/b.py: no such data"]
    text = (checkout / "RESULTS.md").read_text()
    assert text.count("Its text.") == 2 and "| 7 |" in text and "| 1 |" in text
    records = read_records(checkout / "records")
    assert records["a-1"].date > "2026-01-02" == records["b-1"].date and "numpy" in records["a-1"].versions
    before = text
    bench_quick(checkout, 60)
    assert "| 7 |" in capsys.readouterr().out
    assert main(["bench", "all", "--assemble", "--benchmarks", str(checkout)]) == 0
    assert (checkout / "RESULTS.md").read_text() == before


def test_only_some_sections_are_run(checkout):
    assert bench_all(checkout, only=["b-"]) == ["python benchmarks/b.py: no such data"]
    assert read_records(checkout / "records")["a-1"].body.endswith("| 1 |")


def test_a_command_ends_when_its_time_is_over(tmp_path):
    ran = run_command(f"{sys.executable} -c 'import time; time.sleep(60)'", tmp_path, 0.5)
    assert ran.failure == "not done after 0 s" and ran.seconds < 30


def test_a_folder_without_texts_is_refused(tmp_path, capsys):
    with pytest.raises(FileNotFoundError, match="texts in sections/"):
        assemble(tmp_path)
    assert main(["bench", "all", "--benchmarks", str(tmp_path)]) != 0
    assert "expected the folder of a checkout" in capsys.readouterr().err
