"""Hints about code lines of a plugin that often make runs differ; a hint is not a proof."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit.input_file import TEXT_LIMIT, read_input

_CALL_HINTS: Final = tomllib.loads(Path(__file__).with_name("call_hints.toml").read_text(encoding="utf-8"))
_CALLS: Final[dict[str, str]] = {name: hint for hint, names in _CALL_HINTS.items() for name in names}
_RANDOM: Final = ("random.", "np.random.", "numpy.random.")
_SEEDED: Final = ("Random", "default_rng", "RandomState", "Generator", "SeedSequence", "PCG64")
_NOT_RESTORED: Final = "snapshots and resets do not restore it; store it in an attribute of self"
_CHANGING: Final = ("append", "add", "update", "pop", "setdefault", "extend", "insert", "clear", "remove", "discard")
_MOST: Final = 6


@dataclass(frozen=True)
class CodeHint:
    """Hint about one line of code.

    Attributes:
        where: `file:line`.
        text: Code in this line and its effect.
    """

    where: str
    text: str


def hints_in(file: str, first: int, last: int) -> list[CodeHint]:
    """Return hints about a range of lines in a Python file; if there are none, about the module's functions.

    Args:
        file: Path of the file.
        first: First line of the class.
        last: Last line of the class.
    """
    try:
        tree = ast.parse(read_input(file, TEXT_LIMIT))
    except (OSError, ValueError, SyntaxError):
        return []
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.lineno != first]
    others = {line for node in classes if not first <= node.lineno <= last for line in _lines(node)}
    hints = sorted({(line, text) for line, text in _find_hints(tree, (first, last)) if line not in others})
    chosen = [(line, text) for line, text in hints if first <= line <= last] or hints
    return [CodeHint(f"{file}:{line}", text) for line, text in chosen[:_MOST]]


def _lines(node: ast.ClassDef) -> range:
    return range(node.lineno, (node.end_lineno or node.lineno) + 1)


def _find_hints(tree: ast.Module, span: tuple[int, int]) -> Iterator[tuple[int, str]]:
    sets = {name for node in ast.walk(tree) for name in _names_of_sets(node)}
    known = dict(pair for node in ast.walk(tree) for pair in _imported_names(node))
    yield from _module_container_writes(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = _dotted_name(node.func)
            first, dot, rest = name.partition(".")
            words = _call_hint(known.get(first, first) + dot + rest, bool(node.args or node.keywords))
            if words:
                yield node.lineno, f"{name}() {words}"
        elif isinstance(node, ast.Attribute) and _dotted_name(node) == "os.environ":
            yield node.lineno, "os.environ depends on the shell that started the program"
        elif isinstance(node, ast.Attribute) and node.attr == "wanted":
            yield node.lineno, f"{_dotted_name(node)} depends on the subscribers; use it only to skip unused work"
        elif isinstance(node, (ast.Global, ast.Nonlocal)):
            yield node.lineno, f"{type(node).__name__.lower()} {', '.join(node.names)}: {_NOT_RESTORED}"
        elif isinstance(node, (ast.Yield, ast.YieldFrom)):
            yield node.lineno, f"the position of a generator changes: {_NOT_RESTORED}"
        elif isinstance(node, ast.ClassDef) and span[0] <= node.lineno <= span[1]:
            for line, name in _container_assignments(node.body):
                yield line, f"{name} belongs to the class, not to the instance: {_NOT_RESTORED}"
        elif isinstance(node, (ast.For, ast.comprehension)) and _is_set(node.iter, sets):
            yield node.iter.lineno, "iterates over a set, whose order differs between processes; use sorted()"


def _module_container_writes(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Find writes to lists, dicts and sets of the module."""
    names = {name for _, name in _container_assignments(tree.body)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and isinstance(node.ctx, (ast.Store, ast.Del)):
            line, name = node.lineno, _dotted_name(node.value)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in _CHANGING:
            line, name = node.lineno, _dotted_name(node.func.value)
        else:
            continue
        if name in names:
            yield line, f"{name} belongs to the module: {_NOT_RESTORED}"


def _container_assignments(statements: list[ast.stmt]) -> Iterator[tuple[int, str]]:
    """Return the line and the name of each assignment of a list, dict or set."""
    containers = (ast.List, ast.Dict, ast.Set, ast.ListComp, ast.DictComp, ast.SetComp)
    for statement in statements:
        if isinstance(statement, (ast.Assign, ast.AnnAssign)) and isinstance(statement.value, containers):
            yield from ((statement.lineno, _dotted_name(target)) for target in _targets(statement))


def _targets(statement: ast.Assign | ast.AnnAssign) -> list[ast.expr]:
    return statement.targets if isinstance(statement, ast.Assign) else [statement.target]


def _imported_names(node: ast.AST) -> Iterator[tuple[str, str]]:
    """Return the names that an import statement defines, with their full names: `now` -> `time.time`."""
    if isinstance(node, ast.Import):
        yield from ((alias.asname, alias.name) for alias in node.names if alias.asname)
    elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
        yield from ((alias.asname or alias.name, f"{node.module}.{alias.name}") for alias in node.names)


def _call_hint(name: str, has_arguments: bool) -> str:
    if name in _CALLS:
        return _CALLS[name]
    if not name.startswith(_RANDOM):
        return ""
    if name.rpartition(".")[2] in _SEEDED:
        return "" if has_arguments else "has no seed; use self.random(channel) for the simulation's seed"
    return "" if name.endswith(".seed") else "uses a generator without the simulation's seed; use self.random(channel)"


def _names_of_sets(node: ast.AST) -> Iterator[str]:
    """Return the names that a statement assigns a set to."""
    if isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value is not None and _is_set(node.value, set()):
        yield from map(_dotted_name, _targets(node))


def _is_set(node: ast.expr, names: set[str]) -> bool:
    if isinstance(node, (ast.Set, ast.SetComp)):
        return True
    if isinstance(node, ast.Call):
        wrapped = _dotted_name(node.func) in ("list", "tuple", "enumerate", "iter") and len(node.args) == 1
        return _dotted_name(node.func) in ("set", "frozenset") or (wrapped and _is_set(node.args[0], names))
    if isinstance(node, ast.BinOp):
        return _is_set(node.left, names) or _is_set(node.right, names)
    return bool(names) and _dotted_name(node) in names - {""}


def _dotted_name(node: ast.expr) -> str:
    """Return a name such as `a.b.c`; empty for other expressions."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        inner = _dotted_name(node.value)
        return f"{inner}.{node.attr}" if inner else ""
    return ""
