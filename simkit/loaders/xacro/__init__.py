"""xacro: files with macros and expressions, expanded before any other loader sees them.

A document enters; one of plain elements leaves, each with the file and line that it was written in. Expressions compute
and do nothing else; every step, text, list and number is bounded, and files are read inside the resource folders alone.
"""

from __future__ import annotations

import re

from simkit.loaders.resources.xml_reader import Document
from simkit.loaders.xacro.expansion import expand

__all__ = ["expand", "needs_expansion"]

_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)


def needs_expansion(document: Document) -> bool:
    """Whether a file is xacro: by its name, by its elements, or because it declares the name space and computes."""
    if document.path is not None and document.path.suffix == ".xacro":
        return True
    text = document.text
    if b"$" in text and b"<![CDATA[" not in text:  # what xacro has written often says `${...}` in comments alone
        text = _COMMENT.sub(b"", text)
    computes = b"${" in text or b"$(" in text
    return b"<xacro:" in text or (computes and "xmlns:xacro" in document.root.attributes)
