"""Search for loops over sets, whose order differs between processes: the hash of a text is drawn at each start."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Final

from simkit_nodes.syntax_tree import parsed

_COPIES: Final = ("list", "tuple", "enumerate", "iter", "reversed", "zip", "map", "next")


def iterations_over_sets(source: bytes | str) -> Iterator[int]:
    """Yield the lines of a program that depend on the order of a set of texts, or of elements that are not known."""
    try:
        tree = parsed(source)
    except SyntaxError:
        return
    names = _names_of_sets(tree)
    lines: set[int] = set()
    for node in ast.walk(tree):
        iterables: list[ast.expr] = []
        if isinstance(node, (ast.For, ast.AsyncFor, ast.comprehension)):
            iterables = [node.iter]
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _COPIES:
            iterables = list(node.args)
        lines.update(each.lineno for each in iterables if _is_set(each, names))
    yield from sorted(lines)


def _names_of_sets(tree: ast.AST) -> frozenset[str]:
    """Return the names to which a program assigns only sets."""
    sets: set[str] = set()
    others: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value is not None:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                if isinstance(target, ast.Name):
                    (sets if _is_set(node.value, frozenset()) else others).add(target.id)
    return frozenset(sets - others)


def _is_set(node: ast.expr, names: frozenset[str]) -> bool:
    if isinstance(node, ast.Set):
        return any(not isinstance(each, ast.Constant) or isinstance(each.value, (str, bytes)) for each in node.elts)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return node.func.id in ("set", "frozenset")
    return isinstance(node, ast.SetComp) or (isinstance(node, ast.Name) and node.id in names)
