"""``toongeo completion``: what shells need to complete the command, from its parser."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Callable, Iterator

__all__ = ["add_completion", "completion"]

_ABOUT = """print a script that completes this command, for:
  bash: eval "$(toongeo completion bash)" in ~/.bashrc
  zsh:  eval "$(toongeo completion zsh)" in ~/.zshrc
  fish: toongeo completion fish > ~/.config/fish/completions/toongeo.fish"""


def add_completion(
    commands: argparse._SubParsersAction[argparse.ArgumentParser], parser: argparse.ArgumentParser
) -> None:
    """Add ``completion`` to the commands of ``toongeo``, whose whole parser is `parser`."""
    command = commands.add_parser(
        "completion",
        help="print a script that completes this command in a shell",
        description=_ABOUT,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.add_argument("shell", choices=tuple(_SHELLS), metavar="SHELL", help="bash, zsh or fish")
    command.set_defaults(run=lambda options: print(completion(parser, options.shell), end=""))


def completion(parser: argparse.ArgumentParser, shell: str) -> str:
    """A script for a shell: commands, flags and their choices, file names elsewhere.

    Examples
    --------
    >>> parser = argparse.ArgumentParser(prog="draw", add_help=False)
    >>> _ = parser.add_argument("--ink", choices=("red", "blue"), help="colour")
    >>> print(completion(parser, "fish"), end="")
    complete -c draw -n __fish_use_subcommand -l ink -x -a 'red blue' -d colour
    """
    return _SHELLS[shell](parser)


def _parsers(parser: argparse.ArgumentParser, path: str = "") -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """All parsers with the commands that lead to them, ``""`` for the first, ``"bench table1"``."""
    yield path, parser
    for name, command in _commands(parser).items():
        yield from _parsers(command, f"{path} {name}".strip())


def _commands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    found: dict[str, argparse.ArgumentParser] = {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            found |= action.choices
    return found


def _flags(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    return [action for action in parser._actions if action.option_strings]


def _takes_value(action: argparse.Action) -> bool:
    return action.nargs != 0


def _choices(action: argparse.Action) -> str:
    return " ".join(map(str, action.choices or ()))


def _positional_choices(parser: argparse.ArgumentParser) -> str:
    """Those of arguments without a flag, commands among them."""
    return " ".join(_choices(action) for action in parser._actions if not action.option_strings)


def _bash(parser: argparse.ArgumentParser) -> str:
    """One function; where it has nothing to say, the shell completes file names."""
    ways, values, words = [], [], []
    for path, command in _parsers(parser):
        ways += [
            f"      {shlex.quote(f'{path}|{name}')}) way={shlex.quote(f'{path} {name}'.strip())} ;;"
            for name in _commands(command)
        ]
        for action in filter(_takes_value, _flags(command)):
            given = "|".join(shlex.quote(f"{path}|{flag}") for flag in action.option_strings)
            values.append(f"    {given}) words={shlex.quote(_choices(action))} ;;")
        flags = " ".join(flag for action in _flags(command) for flag in action.option_strings)
        both = shlex.quote(f"{_positional_choices(command)} {flags}".strip())
        words.append(f"      {shlex.quote(path)}) words={both} ;;")
    return _BASH.format(name=parser.prog, ways="\n".join(ways), values="\n".join(values), words="\n".join(words))


def _zsh(parser: argparse.ArgumentParser) -> str:
    return f"autoload -U +X compinit && compinit -u\nautoload -U +X bashcompinit && bashcompinit\n{_bash(parser)}"


def _fish(parser: argparse.ArgumentParser) -> str:
    lines = []
    for path, command in _parsers(parser):
        seen = [f"__fish_seen_subcommand_from {name}" for name in path.split()]
        inner = _commands(command)
        if inner and seen:
            seen.append(f"not __fish_seen_subcommand_from {' '.join(inner)}")
        begin = f"complete -c {parser.prog} -n {shlex.quote('; and '.join(seen) or '__fish_use_subcommand')}"
        helps = {choice.dest: choice.help for choice in _command_actions(command)}
        lines += [f"{begin} -f -a {name}{_described(helps.get(name))}" for name in inner]
        if not inner and (choices := _positional_choices(command).strip()):
            lines.append(f"{begin} -f -a {shlex.quote(choices)}")
        for action in _flags(command):
            names = " ".join(map(_fish_flag, action.option_strings))
            value = f" -x -a {shlex.quote(_choices(action))}" if action.choices else " -r" * _takes_value(action)
            lines.append(f"{begin} {names}{value}{_described(action.help)}")
    return "\n".join(lines) + "\n"


def _fish_flag(flag: str) -> str:
    return f"-l {flag[2:]}" if flag.startswith("--") else f"-s {flag[1:]}"


def _command_actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """The commands of a parser with their help."""
    return [
        choice
        for action in parser._actions
        if isinstance(action, argparse._SubParsersAction)
        for choice in action._choices_actions
    ]


def _described(text: str | None) -> str:
    return "" if not text or text == argparse.SUPPRESS else f" -d {shlex.quote(text)}"


# `way` are the commands that were typed. An empty answer leaves file names to the shell (-o default).
_BASH = """_{name}() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD-1]}}" way= words= i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$way|${{COMP_WORDS[i]}}" in
{ways}
    esac
  done
  case "$way|$previous" in
{values}
    *) case "$way" in
{words}
    esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _{name} {name}
"""
_SHELLS: dict[str, Callable[[argparse.ArgumentParser], str]] = {"bash": _bash, "zsh": _zsh, "fish": _fish}
