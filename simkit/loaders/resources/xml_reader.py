"""Reader of XML files and texts, with limits and with messages for files of another format."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final
from xml.parsers import expat

from simkit import progress
from simkit.diagnostics import Diagnostics, Where, shorten
from simkit.input_file import GIT_LFS_POINTER, GIT_LFS_TEXT, FileTooLargeError, read_input
from simkit.number_text import counted
from simkit.params import Params
from simkit.scene.simkit_elements import PREFIX
from simkit.template_texts import find_template_text, may_have_template_texts

ALLOWED_FORMATS: Final = "a world or model file is XML that begins with <sdf>, <robot> (URDF, xacro) or <mujoco> (MJCF)"

_FOREIGN_SIGNATURES: Final[tuple[tuple[bytes, str], ...]] = (
    (b"\x1f\x8b", "a gzip file; unpack it first"),
    (b"PK\x03\x04", "a zip archive; unpack it first"),
    (b"BZh", "a bzip2 file; unpack it first"),
    (b"\xfd7zXZ", "an xz file; unpack it first"),
    (b"\x28\xb5\x2f\xfd", "a zstd file; unpack it first"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"glTF", "a glTF mesh"),
    (b"solid ", "an STL mesh"),
    (b"ply\n", "a PLY mesh"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
    (b"\x89MCAP", "an MCAP recording"),
    (b"#ROSBAG", "a ROS 1 bag"),
    (b"SQLite format 3", "an SQLite file, perhaps a ROS 2 bag"),
    (b"%PDF", "a PDF document"),
    (GIT_LFS_POINTER, GIT_LFS_TEXT),
    (b"#!", "a script"),
)
_FOREIGN_ROOTS: Final = {
    "COLLADA": "a mesh (COLLADA); name it in the <uri> of a <mesh>",
    "launch": "a ROS launch file; run it with `simkit launch FILE`",
    "package": "a package.xml; load a model in its folder",
    "model": "a model without its <sdf>, or a model.config; put <sdf version='1.9'> around it, or load its folder",
    "world": "a world without the <sdf> around it; put <sdf version='1.9'> around it",
    "sdformat": "it is spelt <sdf>",
    "mujocoinclude": "a part of an MJCF file; load the file that includes this part",
    "svg": "a drawing (SVG)",
    "html": "a web page",
    "OpenDRIVE": "a road map (OpenDRIVE)",
    "osm": "a map (OpenStreetMap)",
    "srdf": "a semantic description; load the URDF that it belongs to",
}


def report_foreign_format(data: bytes, where: Where, diagnostics: Diagnostics) -> bool:
    """Check whether a file cannot be XML, and record an error that names its likely format and the allowed ones."""
    likely_format = _describe_content(data)
    if likely_format:
        diagnostics.error("SK-XML-005", f"this is not XML; it looks like {likely_format}", where, ALLOWED_FORMATS)
    return bool(likely_format)


def foreign_root_hint(name: str) -> str:
    """Describe a file by its root element of another format; empty if the format is unknown."""
    return _FOREIGN_ROOTS.get(name, "")


def _describe_content(data: bytes) -> str:
    head = data[:4096].removeprefix(b"\xef\xbb\xbf").lstrip()
    if not head:
        return "an empty file"
    if head.startswith(b"<") or data.startswith((b"\xff\xfe", b"\xfe\xff", b"<\0", b"\0<")):
        return ""
    for start, name in _FOREIGN_SIGNATURES:
        if head.startswith(start):
            return name
    if _is_binary_stl(data):
        return "an STL mesh"
    if head.startswith((b"{", b"[")):
        return "JSON"
    if head.startswith((b"v ", b"o ", b"mtllib ", b"# Blender")) or b"\nv " in head:
        return "an OBJ mesh"
    if head.startswith(b"world: ") or b"\nworld: " in head:
        return "a scenario; simkit golden record runs it with its checks"
    if b"\0" in head:
        return "a binary file"
    if b"<" not in data:
        return "a text without any element"
    return f"a text that begins with {shorten(head.decode('utf-8', errors='replace').splitlines()[0], 40)!r}"


def _is_binary_stl(data: bytes) -> bool:
    return len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")


MAX_BYTES = 256 * 1024 * 1024
MAX_DEPTH = 200
MAX_ELEMENTS = 3_000_000
_PLAIN_AMPERSAND = re.compile(rb"(<!\[CDATA\[.*?\]\]>)|&(?!#?\w+;)", re.DOTALL)
_MOST_TEMPLATE_TEXTS = 3
_DECLARATION = re.compile(rb"<\?xml\b[^?]*\?>")


@dataclass(frozen=True, slots=True)
class Document:
    """One parsed file.

    Attributes:
        root: the outermost element.
        path: the file, or None for XML given as text.
        text: bytes of the file.
        arguments: arguments that a xacro file declares, with their values.
    """

    root: Params
    path: Path | None
    text: bytes
    arguments: Mapping[str, str] = field(default_factory=dict)

    @property
    def folder(self) -> Path | None:
        """Folder that relative URIs of this file start from."""
        return None if self.path is None else self.path.parent


def without_comments(text: bytes, *, keep_lines: bool = False) -> bytes:
    """Remove the comments from XML; `keep_lines` keeps their line feeds.

    A regular expression would look for the end of each comment again, if the last one has no end.
    """
    pieces: list[bytes] = []
    at = 0
    while (start := text.find(b"<!--", at)) >= 0 and (end := text.find(b"-->", start + 4)) >= 0:
        pieces += text[at:start], b"\n" * text.count(b"\n", start, end) if keep_lines else b""
        at = end + 3
    return b"".join((*pieces, text[at:]))


class _RefusedDocument(Exception):
    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code


class _TreeBuilder:
    """Builder of the element tree from expat's events, with limits on size and depth."""

    def __init__(self, file: str | None, diagnostics: Diagnostics, keep_space: bool) -> None:
        self.file, self.offset, self.diagnostics, self.keep_space = file, 0, diagnostics, keep_space
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.EntityDeclHandler = self.entity
        self.stack: list[tuple[Params, list[str]]] = []  # open elements and their texts
        self.root: Params | None = None
        self.count = 0

    def read(self, data: bytes) -> Params | None:
        """Parse the whole text; white space before the XML declaration is skipped."""
        body = data if data.startswith((b"\xff\xfe", b"\xfe\xff")) else data.lstrip()
        self.offset = data[: len(data) - len(body)].count(b"\n")
        self.parser.Parse(body, True)
        # the parser and this object refer to each other: the tree would stay in memory until garbage collection
        root, self.root = self.root, None
        return root

    @property
    def line(self) -> int:
        return self.parser.CurrentLineNumber + self.offset

    @property
    def inside(self) -> str:
        """Description of the innermost open element, for a message."""
        if not self.stack:
            return ""
        element = self.stack[-1][0]
        return f" (inside <{element.name}> of line {element.where.line})"

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count > MAX_ELEMENTS:
            raise _RefusedDocument("SK-XML-002", f"more than {MAX_ELEMENTS} elements")
        if len(self.stack) >= MAX_DEPTH:
            raise _RefusedDocument("SK-XML-002", f"elements nested deeper than {MAX_DEPTH}")
        where = Where(self.file, self.parser.CurrentLineNumber + self.offset, self.count)
        element = Params(name.removeprefix(PREFIX), "", attributes, (), where, self.diagnostics)
        if self.stack:
            self.stack[-1][0].children.append(element)
        self.stack.append((element, []))

    def characters(self, text: str) -> None:
        if self.stack:
            texts = self.stack[-1][1]
            if texts or self.keep_space or not text.isspace():
                texts.append(text)

    def end(self, _name: str) -> None:
        element, texts = self.stack.pop()
        if texts:
            joined = "".join(texts)
            element.value = joined if self.keep_space else joined.strip()
        if not self.stack:
            self.root = element

    def entity(self, name: str, *_rest: object) -> None:
        raise _RefusedDocument("SK-XML-003", f"the file declares the entity {name!r}; entities are not supported")


def parse_text(
    text: str | bytes, diagnostics: Diagnostics, file: str | None = None, *, keep_space: bool = False
) -> Params | None:
    """Parse an XML text; return its root element, or None, with an error recorded, if it cannot be read.

    Args:
        text: XML; bytes can be in any encoding that their declaration names.
        diagnostics: receives the problems.
        file: name for `file:line`; None for text that is not from a file.
        keep_space: keep the white space around the texts of elements, which matters if they are YAML.
    """
    data = text.encode() if isinstance(text, str) else text
    if len(data) > MAX_BYTES:
        diagnostics.error(
            "SK-XML-002", f"the file has {counted(len(data), 'byte')}; the limit is {MAX_BYTES}", Where(file)
        )
        return None
    if isinstance(text, str) and data.lstrip().startswith(b"<?xml"):
        declaration, _, rest = data.lstrip().partition(b"?>")
        blank = data[: len(data) - len(data.lstrip())]
        data = blank + b"<?xml version='1.0'?>" + b"\n" * declaration.count(b"\n") + rest
    reader = _TreeBuilder(file, diagnostics, keep_space)
    try:
        return reader.read(data)
    except expat.ExpatError as error:
        stripped = _lenient_text(data)
        root = None
        if stripped is not None:
            root = _parse_lenient_text(stripped, _TreeBuilder(file, diagnostics, keep_space))
        message, where = expat.ErrorString(error.code), Where(file, error.lineno + reader.offset)
        if root is not None:
            diagnostics.warning("SK-XML-004", f"not strictly valid XML, but accepted: {message}", where)
            return root
        diagnostics.error("SK-XML-001", f"broken XML: {message}{reader.inside}", where)
    except _RefusedDocument as refused:
        diagnostics.error(refused.code, str(refused), Where(file, reader.line))
    except (LookupError, ValueError) as error:
        diagnostics.error("SK-XML-001", f"broken XML: {error}", Where(file, reader.line))
    return None


def _lenient_text(data: bytes) -> bytes | None:
    """Return the text as lenient readers see it: without comments and declaration, and up to the first zero byte.

    An `&` that begins no entity, as in `<description>Salt & pepper</description>`, is the character, as for tinyxml2.
    None if this is the whole text. In UTF-16, zero bytes are parts of letters.
    """
    is_wide = data.startswith((b"\xff\xfe", b"\xfe\xff", b"<\0", b"\0<"))
    plain = data if is_wide else data.partition(b"\0")[0]
    plain = without_comments(plain, keep_lines=True)
    plain = _DECLARATION.sub(lambda m: b"\n" * m.group().count(b"\n"), plain)
    if not is_wide:
        plain = _PLAIN_AMPERSAND.sub(lambda m: m.group(1) or b"&amp;", plain)
    return plain if plain != data else None


def _parse_lenient_text(data: bytes, builder: _TreeBuilder) -> Params | None:
    try:
        return builder.read(data)
    except (expat.ExpatError, _RefusedDocument, LookupError, ValueError):
        return None


def report_template_texts(document: Document, diagnostics: Diagnostics) -> None:
    """Warn of texts in a file that a launch file, xacro or a template engine was to fill in."""
    if not may_have_template_texts(document.text):
        return
    found: dict[str, tuple[Where, str]] = {}
    stack = [document.root]
    while stack:
        element = stack.pop()
        stack += reversed(element.children)
        for text in (*element.attributes.values(), element.value):
            unfilled, advice = find_template_text(text)
            if unfilled:
                found.setdefault(unfilled, (element.where, advice))
    for text, (where, advice) in list(found.items())[:_MOST_TEMPLATE_TEXTS]:
        diagnostics.warning("SK-XML-006", f"the text {shorten(text, 60)!r} was not filled in", where, advice)


def parse_file(path: Path, diagnostics: Diagnostics, *, keep_space: bool = False) -> Document | None:
    """Read one XML file; return None, with an error recorded, if it cannot be read; see `parse_text`."""
    progress.set_item(path.name)
    try:
        text = read_input(path, MAX_BYTES, allow_pipe=True)
    except FileTooLargeError as error:
        diagnostics.error("SK-XML-002", f"cannot read the file: {error.strerror}", Where(str(path)))
        return None
    except OSError as error:
        diagnostics.error("SK-LOAD-002", f"cannot read the file: {error.strerror or error}", Where(str(path)))
        return None
    if report_foreign_format(text, Where(str(path)), diagnostics):
        return None
    root = parse_text(text, diagnostics, str(path), keep_space=keep_space)
    return None if root is None else Document(root, path, text)
