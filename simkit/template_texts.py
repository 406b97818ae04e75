"""Texts that a launch file, xacro or a template engine was to fill in, and that are still in a file."""

from __future__ import annotations

import re
from typing import Final

_XACRO: Final = "xacro fills it in: load the .xacro file itself, or rename the file to NAME.xacro and pass NAME:=VALUE"
_KINDS: Final[tuple[tuple[str, str], ...]] = (
    (r"\$\((?!find\b|find-)[a-z_-]+ [^()]*\)|\$\{[^{}]+\}", _XACRO),
    (r"\{\{[^{}]+\}\}|\{%.*?%\}", "a template engine such as Jinja fills it in: run it, and load its result"),
    (r"__[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*__|@[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*@",
     "a launch file or a build fills it in: `simkit launch FILE` runs launch files; or write the value"),
)  # fmt: skip
"""Pattern of each kind of text, and what fills it in. `$(find PACKAGE)` is a part of URIs, which simkit resolves."""
_BEGINNINGS: Final = re.compile(rb"\$[({]|\{[{%]|__[A-Z]|@[A-Z]")
"""Beginning of a text of each kind; most files have none, so that their elements need no search."""
_PATTERN: Final = re.compile("|".join(f"({pattern})" for pattern, _ in _KINDS))


def may_have_template_texts(content: bytes) -> bool:
    """Check for a beginning of a text that was to be filled in, in the content of a file."""
    return _BEGINNINGS.search(content) is not None


def find_template_text(text: str) -> tuple[str, str]:
    """Return the first text that was to be filled in, and the advice for it; two empty texts for none."""
    match = _PATTERN.search(text) if text else None
    if match is None or match.lastindex is None:
        return "", ""
    return match[0], _KINDS[match.lastindex - 1][1]
