"""Syntax trees of programs."""

from __future__ import annotations

import ast

from simkit.garbage_collection import no_collection


def parsed(source: bytes | str) -> ast.Module:
    """Return the syntax tree of a Python file.

    The garbage collector waits: it may delete an object of an ended program whose destructor prints a traceback, which
    parses, too. CPython 3.11 then raises SystemError (AST constructor recursion depth mismatch).

    Raises:
        SyntaxError, ValueError: the text is not Python 3.
    """
    with no_collection():
        return ast.parse(source)
