"""Small faults, one at a time, in a piece of Python: what `mutation.py` puts into the library."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass

__all__ = ["Mutant", "mutants"]

COMPARED = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
COMBINED = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult, ast.Pow: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
CALLED = (
    ("min", "max"), ("minimum", "maximum"), ("any", "all"), ("floor", "ceil"), ("argmin", "argmax"), ("sin", "cos"),
    ("sum", "mean"), ("zeros", "ones"), ("hstack", "vstack"), ("sqrt", "abs"),
)  # fmt: skip
RENAMED = {**dict(CALLED), **{b: a for a, b in CALLED}}
FACTOR = 2  # of a number that is not whole
# What cannot be seen from outside, or is no code: types, decorators (caches), messages, and what a module exports.
UNSEEN = (ast.JoinedStr, ast.Raise, ast.Import, ast.ImportFrom, ast.AnnAssign)


@dataclass(frozen=True)
class Mutant:
    """A piece of a file and what stands there instead."""

    line: int
    start: int  # bytes from the begin of the file
    stop: int
    kind: str
    before: str
    after: str

    def applied(self, source: bytes) -> bytes:
        """The file with the fault."""
        return source[: self.start] + self.after.encode() + source[self.stop :]


def mutants(source: bytes) -> list[Mutant]:
    """Every fault this module knows for a file, in the order of the file.

    Comparisons get or lose equality or turn to their opposite, arithmetic operators and `and`/`or` are exchanged, signs
    and `not` vanish, numbers and truth values change, functions become their counterpart (min: max), branches are
    always or never taken, statements vanish, and functions return their first argument.
    """
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    found = {}
    for node, kind, after in _changes(ast.parse(source)):
        start = starts[node.lineno - 1] + node.col_offset
        stop = starts[node.end_lineno - 1] + node.end_col_offset
        before = source[start:stop].decode()
        if after != before:
            found[start, stop, after] = Mutant(node.lineno, start, stop, kind, before, after)
    return [found[key] for key in sorted(found)]


def _changes(tree: ast.AST) -> Iterator[tuple[ast.expr | ast.stmt, str, str]]:
    """A node, the kind of the fault, and the text to put in its place."""
    waiting: list[tuple[ast.AST, str | None]] = [(tree, None)]
    while waiting:
        node, first = waiting.pop()
        if isinstance(node, ast.FunctionDef):
            arguments = [a.arg for a in (*node.args.posonlyargs, *node.args.args) if a.arg not in ("self", "cls")]
            first = arguments[0] if arguments else None
        if isinstance(node, ast.Return) and node.value is not None and first is not None:
            yield node.value, "return", first
        if isinstance(node, ast.expr):
            yield from _of_expression(node)
        elif isinstance(node, ast.stmt):
            yield from _of_statement(node)
        waiting += [(child, first) for child in _seen_children(node)]


def _seen_children(node: ast.AST) -> Iterator[ast.AST]:
    for name, field in ast.iter_fields(node):
        if name in ("decorator_list", "annotation", "returns"):
            continue
        for child in field if isinstance(field, list) else [field]:
            exported = isinstance(child, ast.Assign) and ast.unparse(child.targets[0]) == "__all__"
            typed = isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
            if isinstance(child, ast.AnnAssign) and child.value is not None:
                yield child.value
            elif isinstance(child, ast.AST) and not isinstance(child, UNSEEN) and not exported and not typed:
                yield child


def _of_expression(node: ast.expr) -> Iterator[tuple[ast.expr, str, str]]:
    if isinstance(node, ast.Compare):
        for k, op in enumerate(node.ops):
            ops = [*node.ops[:k], COMPARED[type(op)](), *node.ops[k + 1 :]]
            yield node, "comparison", _text(node, ops=ops)
    elif isinstance(node, ast.BinOp) and type(node.op) in COMBINED:
        yield node, "arithmetic", _text(node, op=COMBINED[type(node.op)]())
    elif isinstance(node, ast.BoolOp):
        yield node, "logic", _text(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    elif isinstance(node, ast.UnaryOp):
        yield node, "sign", f"({ast.unparse(node.operand)})"
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float):
        yield node, "constant", _other_number(node.value)
    elif isinstance(node, ast.IfExp):
        yield from ((node.test, "branch", value) for value in ("True", "False"))
    elif isinstance(node, ast.Call):
        yield from _of_call(node)


def _of_call(node: ast.Call) -> Iterator[tuple[ast.expr, str, str]]:
    name = node.func
    if isinstance(name, ast.Attribute) and name.attr in RENAMED:
        yield name, "function", _text(name, attr=RENAMED[name.attr], bare=True)
    elif isinstance(name, ast.Name) and name.id in RENAMED:
        yield name, "function", RENAMED[name.id]


def _of_statement(node: ast.stmt) -> Iterator[tuple[ast.expr | ast.stmt, str, str]]:
    if isinstance(node, ast.If | ast.While):
        values = ("False",) if isinstance(node, ast.While) else ("True", "False")
        yield from ((node.test, "branch", value) for value in values)
    elif isinstance(node, ast.Break | ast.Continue):
        yield node, "loop", "continue" if isinstance(node, ast.Break) else "break"
    elif isinstance(node, ast.AugAssign):
        yield node, "statement", "pass"
        if type(node.op) in COMBINED:
            yield node, "arithmetic", _text(node, op=COMBINED[type(node.op)](), bare=True)
    elif isinstance(node, ast.Expr | ast.Assign):
        called = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        if called or (isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript)):
            yield node, "statement", "pass"


def _other_number(value: bool | int | float) -> str:
    if isinstance(value, bool):
        return str(not value)
    if isinstance(value, int):
        return str(1 - value if value in (0, 1) else value + 1)
    return repr(value * FACTOR or 1.0)


def _text(node: ast.expr | ast.stmt, *, bare: bool = False, **fields: object) -> str:
    """Source of a node with other fields, in brackets unless it is a statement."""
    changed = copy.copy(node)
    for name, value in fields.items():
        setattr(changed, name, value)
    return ast.unparse(changed) if bare else f"({ast.unparse(changed)})"
