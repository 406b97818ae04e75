"""Expansion of xacro files, as the Python package `xacro`, with the packages of the workspace.

While a launch file is read, a file that cannot be expanded is left out with a warning; elsewhere it is an exception.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any
from xml.dom.minidom import Document, parseString

from simkit.extend import Diagnostics
from simkit.input_file import read_input_text
from simkit_launch.action_places import calling_place
from simkit_launch.command_output import xacro_output
from simkit_launch.planner import planner_or_none

__all__ = ["XacroException", "open_output", "parse", "process", "process_doc", "process_file"]


class XacroException(Exception):
    """A xacro file cannot be expanded."""


class _LeftOut(Document):
    """Document of a file that is left out; its text is empty."""

    def toxml(self, *args: Any, **kwargs: Any) -> str:  # type: ignore[override]
        """Return an empty text."""
        return ""

    def toprettyxml(self, *args: Any, **kwargs: Any) -> str:  # type: ignore[override]
        """Return an empty text."""
        return ""


def process(
    input_file_name: str | os.PathLike[str], *args: Any, mappings: Mapping[str, Any] | None = None, **kwargs: Any
) -> str:
    """Return the expanded text of a file."""
    del args, kwargs
    words = [os.fspath(input_file_name), *(f"{name}:={value}" for name, value in (mappings or {}).items())]
    planner = planner_or_none()
    if planner is not None:
        words[0] = str(planner.source_of(Path(words[0]).absolute()))
        return planner.command_output(["xacro", *words])
    problems = Diagnostics()
    text = xacro_output(words, calling_place(), problems)
    if text is None:
        raise XacroException("; ".join(each.message for each in problems))
    return text


def process_file(input_file_name: str | os.PathLike[str], **kwargs: Any) -> Document:
    """Return the expanded document of a file."""
    text = process(input_file_name, **kwargs)
    return parseString(text) if text else _LeftOut()


def parse(inp: str | IO[Any] | None, filename: str | None = None) -> Document:
    """Return the document of a text, an open file, or a file with a name, without its expansion."""
    name = filename or getattr(inp, "name", None)
    if inp is None:
        text: Any = read_input_text(Path(name or ""))
    else:
        text = inp if isinstance(inp, str) else inp.read()
    document = parseString(text)
    vars(document)["xacro_file"] = name
    return document


def process_doc(doc: Document, *, mappings: Mapping[str, Any] | None = None, **kwargs: Any) -> None:
    """Expand a document in place."""
    del kwargs
    name = vars(doc).get("xacro_file")
    if name is None:
        planner = planner_or_none()
        if planner is None:
            raise XacroException("a document without a file cannot be expanded")
        name = str(planner.write_file("document", ".xacro", doc.toxml()))
    expanded = process_file(name, mappings=mappings)
    while doc.firstChild is not None:
        doc.removeChild(doc.firstChild)
    for node in tuple(expanded.childNodes):
        doc.appendChild(node)
    if isinstance(expanded, _LeftOut):
        doc.__class__ = _LeftOut


def open_output(output_filename: str | None) -> IO[str]:
    """Return an output file; the standard output for None."""
    if output_filename is None:
        return sys.stdout
    path = Path(output_filename)
    path.parent.mkdir(parents=True, exist_ok=True)
    return path.open("w", encoding="utf-8")
