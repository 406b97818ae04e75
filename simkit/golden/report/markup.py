"""Text into markup: whatever it holds, it stays text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import Final

from simkit.diagnostics import shortened

_LONGEST: Final = 2_000
# what XML cannot hold, and the marks that turn the order of letters round, which could make a name read as another
_ILLEGAL: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff\u202a-\u202e\u2066-\u2069\u200e\u200f]"
)


def cleaned(text: str) -> str:
    """A text without what a terminal or a reader would take for more than letters."""
    return _ILLEGAL.sub("\ufffd", text)


def escaped(text: object) -> str:
    """Any text, for between tags and in attributes; a very long one is cut."""
    return escape(cleaned(shortened(str(text), _LONGEST)), quote=True)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], marked: Iterable[bool] = ()) -> str:
    """A table that can be moved sideways where it is too wide.

    Args:
        heads: of the columns, as text.
        rows: cells, as markup.
        marked: whether each row stands out.
    """
    marks = list(marked)
    body = ""
    for number, row in enumerate(rows):
        stands_out = ' class="differs"' if number < len(marks) and marks[number] else ""
        body += f"<tr{stands_out}>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>"
    head = "".join(f"<th>{escaped(name)}</th>" for name in heads)
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'
