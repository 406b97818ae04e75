"""Byte positions of the inertia numbers in a file, so that they can be replaced without changing any other byte."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from simkit.input_file import read_input
from simkit.loaders.resources.xml_reader import MAX_BYTES
from simkit.loaders.sdf.inertial import MOMENT_NAMES

_SDF_DEFAULTS = {"ixx": 1.0, "iyy": 1.0, "izz": 1.0, "ixy": 0.0, "ixz": 0.0, "iyz": 0.0}


@dataclass
class WrittenInertia:
    """Inertia of one link, as written in the file.

    Attributes:
        link: name of the link.
        line: line number of its `<inertia>`.
        mass: mass [kg]; 1 if the file gives no mass.
        values: ixx, iyy, izz, ixy, ixz, iyz [kg·m²] in the axes of its `<inertial>`.
        spans: byte range of each number in the file, by name (`ixx`, ...); missing numbers have none.
        end: byte position at which a missing number can be inserted.
        is_urdf: true if the numbers are attributes (URDF), false if they are elements (SDF).
        is_rotated: true if the pose of the `<inertial>` has a rotation.
    """

    link: str
    line: int
    is_urdf: bool
    mass: float = 1.0
    is_rotated: bool = False
    values: dict[str, float] = field(default_factory=dict)
    spans: dict[str, tuple[int, int]] = field(default_factory=dict)
    end: int = -1

    @property
    def moments(self) -> tuple[float, float, float, float, float, float]:
        """Moments ixx, iyy, izz, ixy, ixz, iyz [kg·m²] in the axes of the `<inertial>`."""
        a, b, c, d, e, f = (self.values[k] for k in MOMENT_NAMES)
        return a, b, c, d, e, f


class _InertiaFinder:
    """Recorder of the byte positions of all inertias in a file, from the events of the XML parser expat."""

    def __init__(self, data: bytes) -> None:
        self.data, self.stack = data, list[str]()
        self.links: list[str] = []
        self.found: list[WrittenInertia] = []
        self.mass: float | None = None
        self.is_rotated = False
        self.is_urdf = False
        self.open: WrittenInertia | None = None
        self.number_from = -1
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.EntityDeclHandler = self.entity

    def entity(self, *_: object) -> None:
        raise ValueError("the file declares an entity")

    def tag_end(self) -> int:
        """Return the byte position after the `>` of the current start tag."""
        position, quote = self.parser.CurrentByteIndex, 0
        while position < len(self.data):
            byte = self.data[position]
            if quote:
                quote = 0 if byte == quote else quote
            elif byte in b"\"'":
                quote = byte
            elif byte == ord(">"):
                return position + 1
            position += 1
        return len(self.data)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        if not self.stack:
            self.is_urdf = name == "robot"
        self.stack.append(name)
        where = self.stack[-4:]
        if name == "link":
            self.links.append(attributes.get("name", ""))
        elif name == "inertial":
            self.mass, self.is_rotated = None, False
        elif name == "origin" and where[-2:-1] == ["inertial"]:
            self.is_rotated = _has_rotation(attributes.get("rpy", ""))
        elif name == "pose" and where[-2:-1] == ["inertial"]:
            self.number_from = self.tag_end()
        elif name == "mass" and where[-2:-1] == ["inertial"]:
            self.number_from = self.tag_end()
            if "value" in attributes:
                self.mass = float(attributes["value"])
        elif name == "inertia" and where[-2:-1] == ["inertial"] and self.links:
            self.open = WrittenInertia(self.links[-1], self.parser.CurrentLineNumber, self.is_urdf)
            self.open.values = dict(_SDF_DEFAULTS) if not self.is_urdf else dict.fromkeys(MOMENT_NAMES, 0.0)
            if self.is_urdf:
                self.attributes(self.open)
        elif name in MOMENT_NAMES and self.open is not None:
            self.number_from = self.tag_end()

    def attributes(self, inertia: WrittenInertia) -> None:
        begin, finish = self.parser.CurrentByteIndex, self.tag_end()
        tag = self.data[begin:finish]
        for key in MOMENT_NAMES:
            match = re.search(rb"\s" + key.encode() + rb"\s*=\s*([\"'])(.*?)\1", tag, re.DOTALL)
            if match:
                inertia.values[key] = float(match[2].decode())
                inertia.spans[key] = (begin + match.start(2), begin + match.end(2))
        inertia.end = finish - (2 if tag.endswith(b"/>") else 1)

    def end(self, name: str) -> None:
        position = self.parser.CurrentByteIndex
        self.stack.pop()
        if name in MOMENT_NAMES and self.open is not None and self.stack[-1:] == ["inertia"]:
            self.open.spans[name] = (self.number_from, position)
            self.open.values[name] = float(self.data[self.number_from : position].decode())
        elif name == "mass" and self.stack[-1:] == ["inertial"] and not self.is_urdf:
            self.mass = float(self.data[self.number_from : position].decode())
        elif name == "pose" and self.stack[-1:] == ["inertial"]:
            text = self.data[self.number_from : position].decode()
            self.is_rotated = _has_rotation(" ".join(text.split()[3:]))
        elif name == "inertia" and self.open is not None:
            if not self.is_urdf:
                self.open.end = position
            self.found.append(self.open)
            self.open = None
        elif name == "inertial" and self.found and self.links and self.found[-1].link == self.links[-1]:
            self.found[-1].is_rotated = self.is_rotated
            if self.mass is not None:
                self.found[-1].mass = self.mass
        elif name == "link":
            self.links.pop()


def _has_rotation(text: str) -> bool:
    """Check whether the angles of a pose contain anything but zeros."""
    return any(word.strip("+-0.") for word in text.split())


def find_inertias(path: Path) -> tuple[bytes, list[WrittenInertia]]:
    """Read a file and find every inertia in it.

    Returns:
        The bytes of the file, and its inertias in document order.

    Raises:
        OSError: the file cannot be read.
        ValueError: the file is not XML in UTF-8, or one of its numbers cannot be read.
    """
    data = read_input(path, MAX_BYTES)
    data.decode("utf-8")
    finder = _InertiaFinder(data)
    try:
        finder.parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ValueError(f"is not well-formed XML: {error}") from None
    return data, finder.found


def replace_numbers(data: bytes, changes: Sequence[tuple[WrittenInertia, Mapping[str, str]]]) -> bytes:
    """Return the file with the given numbers replaced or inserted; every other byte stays the same.

    Args:
        data: the bytes of the file.
        changes: pairs of an inertia and its new numbers, as text by key (`ixx`, ...).
    """
    edits: list[tuple[int, int, bytes]] = []
    for inertia, texts in changes:
        for key, text in texts.items():
            if key in inertia.spans:
                edits.append((*inertia.spans[key], text.encode()))
            else:
                added = f' {key}="{text}"' if inertia.is_urdf else f"<{key}>{text}</{key}>"
                edits.append((inertia.end, inertia.end, added.encode()))
    out: list[bytes] = []
    position = 0
    for begin, finish, new in sorted(edits, key=lambda e: e[0]):
        out += [data[position:begin], new]
        position = finish
    return b"".join([*out, data[position:]])
