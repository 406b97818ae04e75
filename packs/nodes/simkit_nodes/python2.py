"""Programs for Python 2, which no Python that runs simkit can execute."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.input_file import TEXT_LIMIT, read_input

_SIGNS: Final = {
    "the print statement": re.compile(r"^\s*print\s+(?![=.(\[]|in\b|is\b|if\b)\S", re.MULTILINE),
    "except with a comma": re.compile(r"^\s*except\s+[\w.]+\s*,\s*\w+\s*:", re.MULTILINE),
    "raise with a comma": re.compile(r"^\s*raise\s+[\w.]+\s*,", re.MULTILINE),
    "the exec statement": re.compile(r"^\s*exec\s+[\"'\w]", re.MULTILINE),
    "the operator <>": re.compile(r"\w\s*<>\s*\w"),
}
"""Statements that only Python 2 has, by their name."""


def refuse_python2(file: Path) -> None:
    """Refuse a file that only Python 2 can execute; a file with any other mistake is not refused.

    Raises:
        InputError: SK-NODE-041 the file is written for Python 2.
        OSError: the file cannot be read.
    """
    data = read_input(file, TEXT_LIMIT)
    try:
        compile(data, str(file), "exec", dont_inherit=True)
    except TabError as error:
        sign, line = "tabs and spaces mixed in the indentation", error.lineno or 1
    except (SyntaxError, ValueError) as error:
        match = _first_sign(data.decode(errors="replace"))
        if match is None:
            return
        sign, line = match
        line = error.lineno or line if sign == "the print statement" and isinstance(error, SyntaxError) else line
    else:
        return
    advice = "convert a copy of it to Python 3, for example with the tool 2to3 of Python 3.12"
    raise InputError("SK-NODE-041", f"{file}:{line}: written for Python 2: {sign}", help=advice)


def _first_sign(text: str) -> tuple[str, int] | None:
    """Return the name and the line of the first statement that only Python 2 has."""
    signs = [(match.start(), name) for name, pattern in _SIGNS.items() if (match := pattern.search(text))]
    if not signs:
        return None
    start, name = min(signs)
    return name, text.count("\n", 0, start) + 1
