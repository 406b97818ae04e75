"""xacro: expansion of files with macros and expressions, before any other loader reads them.

The input is a document; the output is a document of plain elements, each with its original file and line. Expressions
can only compute values. Every step, text, list and number is limited, and files are read only inside the resource
folders.
"""

from __future__ import annotations

from simkit.loaders.resources.xml_reader import Document, without_comments

__all__ = ["needs_expansion"]


def needs_expansion(document: Document) -> bool:
    """Check whether a file is xacro: by its name, by its elements, or by its name space together with expressions."""
    if document.path is not None and document.path.suffix == ".xacro":
        return True
    text = document.text
    if b"$" in text and b"<![CDATA[" not in text:  # output of xacro often contains `${...}` only in comments
        text = without_comments(text)
    computes = b"${" in text or b"$(" in text
    return b"<xacro:" in text or (computes and "xmlns:xacro" in document.root.attributes)
