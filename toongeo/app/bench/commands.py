"""The arguments of ``toongeo bench``."""

import argparse
from pathlib import Path

__all__ = ["add_bench"]

_BENCHMARKS = Path(__file__).parents[3] / "benchmarks"
_QUICK_SECONDS = 570  # ten minutes with what it takes to begin


def add_bench(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add ``bench`` to the commands of ``toongeo``."""
    bench = commands.add_parser("bench", help="tables of errors and seconds over a folder, and blind pairs to judge")
    benches = bench.add_subparsers(required=True, metavar="TABLE")
    for name, about, run in (
        ("table1", "landmark and photometric error, coarse and fine", _table1),
        ("table2", "the same with adjusted coefficients", _table2),
        ("table4", "seconds a stage", _table4),
        ("caricature", "baselines of Wu et al. 2018 and the deformation space", _caricature),
    ):
        table = benches.add_parser(name, help=about)
        _add_folder(table)
        table.add_argument("-o", "--output", type=Path, metavar="OUT", help="folder for a CSV file and a chart")
        if name in ("table1", "table2"):
            table.add_argument("--eos", type=Path, metavar="MODELS", help="compare eos-py too, with its model files")
        table.set_defaults(run=run)
    every = benches.add_parser("all", help="run the benchmarks of a checkout and write its RESULTS.md anew")
    every.add_argument("--quick", action="store_true", help="a small part in ten minutes at most; only prints")
    every.add_argument("--only", action="append", default=[], metavar="SECTION", help="part of a section's name; again")
    about = "a folder or file for a word in capitals of the commands, such as CARTOONS; again"
    every.add_argument("--data", action="append", default=[], type=_named, metavar="NAME=PATH", help=about)
    every.add_argument("--assemble", action="store_true", help="run nothing: texts and records as they are")
    about = "folder of the benchmarks (default: that of this checkout)"
    every.add_argument("--benchmarks", type=Path, default=_BENCHMARKS, metavar="FOLDER", help=about)
    every.set_defaults(run=_all)
    pairs = benches.add_parser("pairs", help="blind sheets of two faces, with a hidden key and an answer form")
    about = "pictures with landmarks beside them; or renders, if a second folder is given"
    pairs.add_argument("folder", type=Path, metavar="FOLDER", help=about)
    pairs.add_argument("new", type=Path, nargs="?", metavar="NEW", help="renders of the same names, to be compared")
    pairs.add_argument("--inputs", type=Path, metavar="DIR", help="pictures to show over renders, of the same stems")
    pairs.add_argument("-o", "--output", type=Path, required=True, metavar="OUT")
    pairs.add_argument("--seed", type=int, default=0, metavar="N", help="of the shuffles (default 0)")
    pairs.add_argument("--against", choices=("coarse", "adjust"), help="the baseline (default coarse)")
    pairs.set_defaults(run=_pairs)
    score = benches.add_parser("score", help="count the answers to the pairs")
    score.add_argument("answers", type=Path, metavar="ANSWERS", help="the form, filled in")
    score.add_argument("key", type=Path, metavar="KEY", help=".key.json of the pairs")
    score.set_defaults(run=_score)


def _add_folder(parser: argparse.ArgumentParser) -> None:
    about = "pictures with landmarks of the same name beside them (.pts, .txt, .csv or .npy)"
    parser.add_argument("folder", type=Path, metavar="FOLDER", help=about)


def _check_output(options: argparse.Namespace, table: str | None = None) -> None:
    """Refuse before the work what could not be written after it, would lie among the pictures, or replace a file."""
    from toongeo.app.bench.save_table import check_table

    output, folder = options.output, options.folder
    if output is None or not output.exists():
        return
    if not output.is_dir():
        raise NotADirectoryError(f"output: expected a folder, got the file {output}")
    for given in (folder, getattr(options, "new", None), getattr(options, "inputs", None)):
        if given is not None and given.exists() and output.samefile(given):
            raise ValueError(f"output: expected another folder than that of the pictures, got {output}")
    if table is not None:
        check_table(table, output)


# The commands import what they need when they run, so that `toongeo --help` answers at once.


def _table1(options: argparse.Namespace) -> None:
    from toongeo.app.bench.save_table import save_table
    from toongeo.app.bench.tables import table1

    _check_output(options, "table1")
    save_table(table1(options.folder, options.eos), "table1", options.output)


def _table2(options: argparse.Namespace) -> None:
    from toongeo.app.bench.save_table import save_table
    from toongeo.app.bench.tables import table2

    _check_output(options, "table2")
    save_table(table2(options.folder, options.eos), "table2", options.output)


def _table4(options: argparse.Namespace) -> None:
    from toongeo.app.bench.save_table import save_table
    from toongeo.app.bench.tables import table4

    _check_output(options, "table4")
    save_table(table4(options.folder), "table4", options.output)


def _caricature(options: argparse.Namespace) -> None:
    from toongeo.app.bench.caricature_table import caricature_table
    from toongeo.app.bench.save_table import save_table

    _check_output(options, "caricature")
    save_table(caricature_table(options.folder), "caricature", options.output)


def _named(text: str) -> tuple[str, str]:
    name, equals, path = text.partition("=")
    if not (equals and name.isupper()):
        raise argparse.ArgumentTypeError(f"expected NAME=PATH, got {text}")
    return name, path


def _all(options: argparse.Namespace) -> None:
    from toongeo.app.bench.results.bench_all import assemble, bench_all, bench_quick

    if not (options.benchmarks / "quick.txt").is_file():
        raise FileNotFoundError(f"benchmarks: expected the folder of a checkout, got {options.benchmarks}")
    if options.quick:
        bench_quick(options.benchmarks, _QUICK_SECONDS)
        return
    troubles = [] if options.assemble else bench_all(options.benchmarks, options.only, dict(options.data))
    if options.assemble:
        assemble(options.benchmarks)
    print("\n".join(f"not run: {trouble}" for trouble in troubles))
    print(f"wrote {options.benchmarks / 'RESULTS.md'}")


def _pairs(options: argparse.Namespace) -> None:
    from toongeo.app.bench.blind_sheets import KEY, QUESTIONS
    from toongeo.app.bench.pair_sheets import pair_sheets
    from toongeo.app.bench.render_pairs import render_pairs

    _check_output(options)
    if options.new is None:
        if options.inputs is not None:
            raise ValueError("inputs: expected two folders of renders to show them over, got one folder")
        sheets = pair_sheets(options.folder, options.output, seed=options.seed, against=options.against or "coarse")
    else:
        if options.against is not None:
            raise ValueError(f"against: expected no baseline beside two folders of renders, got {options.against}")
        sheets = render_pairs(options.folder, options.new, options.output, seed=options.seed, inputs=options.inputs)
    print(f"wrote {len(sheets)} sheets, answers.csv and {KEY} to {options.output}")
    print("Answer A or B for each sheet and question; leave the key closed until all answers are in:")
    print("\n".join(f"  {question}: {words}" for question, words in QUESTIONS.items()))


def _score(options: argparse.Namespace) -> None:
    from toongeo.app.bench.score_answers import preferences_text, score_answers

    print(preferences_text(score_answers(options.answers, options.key)))
