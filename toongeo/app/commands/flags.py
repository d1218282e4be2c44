"""Messages of the library in the words of the command line."""

from __future__ import annotations

import argparse
import re
from collections.abc import Mapping

__all__ = ["in_flags", "know_flags"]

_HEAD = re.compile(r"[a-z_]+(?:, [a-z_]+)*(?=: )")
_LISTED = re.compile(r"(?<=, which has )[a-z_]+(?:, [a-z_]+)*")


def know_flags(parser: argparse.ArgumentParser) -> None:
    """Let a parser and the parsers of its commands tell, with what they parse, which flag sets which parameter.

    A command may set the default ``also``, a mapping from other names of its parameters to flags.
    """
    flags = {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                know_flags(command)
        elif action.option_strings:
            flags[action.dest] = action.option_strings[-1], action.default
        elif action.metavar:
            flags[action.dest] = str(action.metavar), None
    parser.set_defaults(flags=flags)


def in_flags(message: str, options: argparse.Namespace) -> str:
    """A message that begins with names of parameters, as ``output: expected ...``, with their flags.

    A name stays where its flag was not given: then it was not the user who was wrong about it.

    Examples
    --------
    >>> parser = argparse.ArgumentParser()
    >>> _ = parser.add_argument("-o", "--output")
    >>> know_flags(parser)
    >>> in_flags("output: expected a file", parser.parse_args(["-o", "a"]))
    '--output: expected a file'
    >>> in_flags("output: expected a file", parser.parse_args([]))
    'output: expected a file'
    """
    flags: Mapping[str, tuple[str, object]] = getattr(options, "flags", {})
    also: Mapping[str, str] = getattr(options, "also", {})

    def flag(name: str) -> str:
        if name in flags:
            return flags[name][0] if getattr(options, name) != flags[name][1] else name
        return also.get(name, name)

    def listed(found: re.Match[str]) -> str:
        """Of the options of a format, those that the command has."""
        own = {name: word for name, (word, _) in flags.items() if word.startswith("--")} | dict(also)
        return ", ".join(own[name] for name in found[0].split(", ") if name in own) or "none"

    message = _HEAD.sub(lambda found: ", ".join(map(flag, found[0].split(", "))), message, count=1)
    return _LISTED.sub(listed, message)
