"""XML into `Params`: without entities, external references or network, within bounds, with the line of every element.

Names keep their prefix as written (`gz:type`), declared or not, because the files of Gazebo use undeclared ones. Only
our own is taken off: `<simkit:latency>` is `<latency>`, and a file may write either.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.parsers import expat

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.files import read_bounded
from simkit.loaders.foreign import is_foreign
from simkit.params import Params
from simkit.scene.own_elements import PREFIX

MAX_BYTES = 256 * 1024 * 1024
MAX_DEPTH = 200
MAX_ELEMENTS = 3_000_000
_COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
_DECLARATION = re.compile(rb"<\?xml\b[^?]*\?>")


@dataclass(frozen=True, slots=True)
class Document:
    """One parsed file.

    Attributes:
        root: the outermost element.
        path: the file, or None for XML given as text.
        text: the bytes as read.
    """

    root: Params
    path: Path | None
    text: bytes

    @property
    def folder(self) -> Path | None:
        """The folder that relative URIs of this file start from."""
        return None if self.path is None else self.path.parent


class _Refused(Exception):
    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code


class _Reader:
    """Builds the tree from expat's events and keeps the bounds."""

    def __init__(self, file: str | None, diagnostics: Diagnostics) -> None:
        self.file, self.offset, self.diagnostics = file, 0, diagnostics
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.EntityDeclHandler = self.entity
        self.stack: list[tuple[Params, list[str]]] = []  # elements whose end tag has not come yet, and their texts
        self.root: Params | None = None
        self.count = 0

    def read(self, data: bytes) -> Params | None:
        """Parses the whole text; white space before the declaration is passed over."""
        body = data if data.startswith((b"\xff\xfe", b"\xfe\xff")) else data.lstrip()
        self.offset = data[: len(data) - len(body)].count(b"\n")
        self.parser.Parse(body, True)
        # the parser and its reader hold each other: the tree is not to wait for the garbage collector with them
        root, self.root = self.root, None
        return root

    def at(self, error: expat.ExpatError) -> int:
        """The line of an error."""
        return error.lineno + self.offset

    @property
    def line(self) -> int:
        return self.parser.CurrentLineNumber + self.offset

    @property
    def inside(self) -> str:
        """The element that is open, for a message."""
        if not self.stack:
            return ""
        element = self.stack[-1][0]
        return f" (inside <{element.name}> of line {element.where.line})"

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count > MAX_ELEMENTS:
            raise _Refused("SK-XML-002", f"more than {MAX_ELEMENTS} elements")
        if len(self.stack) >= MAX_DEPTH:
            raise _Refused("SK-XML-002", f"elements nested deeper than {MAX_DEPTH}")
        where = Where(self.file, self.parser.CurrentLineNumber + self.offset, self.count)
        element = Params(name.removeprefix(PREFIX), "", attributes, (), where, self.diagnostics)
        if self.stack:
            self.stack[-1][0].children.append(element)
        self.stack.append((element, []))

    def characters(self, text: str) -> None:
        if self.stack:
            texts = self.stack[-1][1]
            if texts or not text.isspace():
                texts.append(text)

    def end(self, _name: str) -> None:
        element, texts = self.stack.pop()
        if texts:
            element.value = "".join(texts).strip()
        if not self.stack:
            self.root = element

    def entity(self, name: str, *_rest: object) -> None:
        raise _Refused("SK-XML-003", f"the file declares the entity {name!r}; entities are not read")


def parse_text(text: str | bytes, diagnostics: Diagnostics, file: str | None = None) -> Params | None:
    """The root element of an XML text; None, with an error recorded, when it cannot be read.

    Args:
        text: XML; bytes may be in any encoding that their declaration names.
        diagnostics: where problems go.
        file: name for `file:line`; None for text that came from no file.
    """
    data = text.encode() if isinstance(text, str) else text
    if len(data) > MAX_BYTES:
        diagnostics.error("SK-XML-002", f"the file has {len(data)} bytes, allowed are {MAX_BYTES}", Where(file))
        return None
    if isinstance(text, str) and data.lstrip().startswith(b"<?xml"):
        declaration, _, rest = data.lstrip().partition(b"?>")
        data = (
            data[: len(data) - len(data.lstrip())] + b"<?xml version='1.0'?>" + b"\n" * declaration.count(b"\n") + rest
        )
    reader = _Reader(file, diagnostics)
    try:
        return reader.read(data)
    except expat.ExpatError as error:
        mended = _mended(data)
        root = None if mended is None else _second_try(mended, file, diagnostics)
        if root is not None:
            text_of = expat.ErrorString(error.code)
            diagnostics.warning(
                "SK-XML-004", f"not strictly XML, read all the same: {text_of}", Where(file, reader.at(error))
            )
            return root
        text_of = expat.ErrorString(error.code)
        diagnostics.error("SK-XML-001", f"broken XML: {text_of}{reader.inside}", Where(file, reader.at(error)))
    except _Refused as refused:
        diagnostics.error(refused.code, str(refused), Where(file, reader.line))
    except (LookupError, ValueError) as error:
        diagnostics.error("SK-XML-001", f"broken XML: {error}", Where(file, reader.line))
    return None


def _mended(data: bytes) -> bytes | None:
    """The text without comments and declaration, as lenient readers take it; None where it has neither."""
    plain = _COMMENT.sub(lambda m: b"\n" * m.group().count(b"\n"), data)
    plain = _DECLARATION.sub(lambda m: b"\n" * m.group().count(b"\n"), plain)
    return plain if plain != data else None


def _second_try(data: bytes, file: str | None, diagnostics: Diagnostics) -> Params | None:
    try:
        return _Reader(file, diagnostics).read(data)
    except (expat.ExpatError, _Refused, LookupError, ValueError):
        return None


def parse_file(path: Path, diagnostics: Diagnostics) -> Document | None:
    """Reads one XML file; None, with an error recorded, when it cannot be read."""
    try:
        text = read_bounded(path, MAX_BYTES)
        if len(text) > MAX_BYTES:
            diagnostics.error("SK-XML-002", f"the file is larger than {MAX_BYTES} bytes", Where(str(path)))
            return None
    except OSError as error:
        diagnostics.error("SK-LOAD-002", f"cannot read the file: {error.strerror or error}", Where(str(path)))
        return None
    if is_foreign(text, Where(str(path)), diagnostics):
        return None
    root = parse_text(text, diagnostics, str(path))
    return None if root is None else Document(root, path, text)
