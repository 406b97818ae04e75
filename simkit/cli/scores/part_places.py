"""Search for the part of a world that a diagnostic belongs to, by the place and the names in the diagnostic."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from simkit.cli.scores.part_list import ELEMENT_KINDS, Part
from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.loaders.resources.xml_reader import parse_file, parse_text
from simkit.params import Params

_QUOTED: Final = re.compile(r"'([^']+)'")
_LINES: Final = re.compile(r"\(line ([^()]+)\)")
_LONGEST_LINE: Final = 10  # digits of the number of a line
_FIRST_WORDS: Final = 3  # words of a message among which it names the kind of its subject
_LEAVES: Final = frozenset(("collision", "visual", "light", "geom"))
"""Elements that are left out as a whole if something inside of them is left out, such as the mesh of a visual."""

_Path = tuple[Params, ...]
"""Element with the elements around it, outermost first."""


class PartPlaces:
    """Parts of a world by their places in the files.

    Args:
        parts: parts of the world.
        diagnostics: diagnostics to find parts for; only the files and lines that they name are read.
        text: XML of a source that is no file; empty for a file.
    """

    def __init__(self, parts: Sequence[Part], diagnostics: Iterable[Diagnostic], text: str = "") -> None:
        self._parts = parts
        self._at: dict[tuple[str | None, int | None], list[int]] = {}
        self._named: dict[str, list[int]] = {}
        for number, part in enumerate(parts):
            self._at.setdefault((part.where.file, part.where.line), []).append(number)
            for name in dict.fromkeys((part.name, part.name.rpartition("::")[2])):
                self._named.setdefault(name, []).append(number)
        files = {part.where.file for part in parts}
        lines: dict[str, set[int]] = {}
        for item in diagnostics:
            for file, line in _places(item):
                if file in files and file and line:
                    lines.setdefault(file, set()).add(line)
        self._elements = {file: _elements_at(file, wanted, text) for file, wanted in lines.items()}

    def find(self, item: Diagnostic, *, left_out: bool) -> Iterator[tuple[list[int], Part | None, bool]]:
        """Find what a diagnostic is about: at each line that it names.

        Args:
            item: diagnostic.
            left_out: True if the diagnostic says that something is left out.

        Yields:
            Numbers of parts; or else a part that the world does not have, because it is left out. The last value is
            True if the whole part is left out.
        """
        for place in _places(item):
            yield self._find_at(replace(item, file=place[0], line=place[1]), left_out=left_out)

    def _find_at(self, item: Diagnostic, *, left_out: bool) -> tuple[list[int], Part | None, bool]:
        """Find what a diagnostic is about at its own place."""
        for path in self._paths(item):
            for depth in range(len(path) - 1, -1, -1):
                element = path[depth]
                if numbers := self._referenced(element):
                    return numbers, None, False
                if element.name not in ELEMENT_KINDS:
                    continue
                is_whole = left_out and (depth == len(path) - 1 or element.name in _LEAVES)
                numbers = self._numbers_of(element, item)
                if numbers:
                    return numbers, None, is_whole
                if is_whole:
                    return [], _missing_part(element), True
        return self._named_parts(item), None, False

    def _paths(self, item: Diagnostic) -> list[_Path]:
        """Return the elements on the line of a diagnostic, the most likely first."""
        paths = self._elements.get(item.file or "", {}).get(item.line or 0, [])
        if len(paths) < 2:
            return list(paths)
        words = [word.strip("<>'") for word in item.message.split()[:_FIRST_WORDS]]
        quoted = _QUOTED.findall(item.message)

        def rank(path: _Path) -> tuple[bool, bool]:
            name = path[-1].attributes.get("name", "")
            return path[-1].name not in words, not any(text == name or text.endswith(f"::{name}") for text in quoted)

        return sorted(paths, key=rank)

    def _referenced(self, element: Params) -> list[int]:
        """Return the link or joint that `<gazebo reference="NAME">` of a URDF file describes further."""
        name = element.attributes.get("reference", "") if element.name == "gazebo" else ""
        numbers = self._named.get(name, []) if name else []
        return [number for number in numbers if self._parts[number].element in ("link", "joint")][:1]

    def _numbers_of(self, element: Params, item: Diagnostic) -> list[int]:
        """Return the parts that an element describes; a macro describes several, of which the message may name one."""
        same_place = self._at.get((element.where.file, element.where.line), [])
        numbers = [number for number in same_place if self._parts[number].element == _part_element(element.name)]
        if len(numbers) < 2:
            return numbers
        quoted = _QUOTED.findall(item.message)
        named = [number for number in numbers if _is_named(self._parts[number].name, quoted)]
        return named or numbers

    def _named_parts(self, item: Diagnostic) -> list[int]:
        """Return the part whose name a message contains, else the first part: the world or the model."""
        for name in _QUOTED.findall(item.message):
            numbers = self._named.get(name, [])
            if len(numbers) == 1:
                return numbers
        return [0] if self._parts else []


def _places(item: Diagnostic) -> Iterator[tuple[str | None, int | None]]:
    """Yield file and line of a diagnostic, and those that its message lists: `model://table (line 12, a.sdf:7)`."""
    listed = [(item.file and f"{item.file}:{item.line}") or ""]
    yield item.file, item.line
    for match in _LINES.finditer(item.message):
        for text in match[1].split(", "):
            file, _, line = text.rpartition(":")
            name = file or item.file
            if line.isdecimal() and len(line) < _LONGEST_LINE and f"{name}:{line}" not in listed:
                listed.append(f"{name}:{line}")
                yield name, int(line)


def _part_element(name: str) -> str:
    return {"robot": "model", "mujoco": "model", "body": "link", "geom": "collision"}.get(name, name)


def _is_named(scoped: str, quoted: Iterable[str]) -> bool:
    return any(text == scoped or scoped.endswith(f"::{text}") or text.endswith(f"::{scoped}") for text in quoted)


def _missing_part(element: Params) -> Part:
    """Return a part that the file describes and the world does not have."""
    uri = next((child.value for child in element.children if child.name == "uri"), "")
    name = uri or element.attributes.get("name", "") or f"<{element.name}>"
    return Part(ELEMENT_KINDS[element.name], element.name, name, element.where)


def _elements_at(file: str, lines: set[int], text: str) -> Mapping[int, list[_Path]]:
    """Return the elements that begin on some lines of a file."""
    if text:
        root = parse_text(text, Diagnostics(), file)
    else:
        document = parse_file(Path(file), Diagnostics())
        root = None if document is None else document.root
    found: dict[int, list[_Path]] = {}
    if root is not None:
        for path in _walk(root):
            line = path[-1].where.line or 0
            if line in lines:
                found.setdefault(line, []).append(path)
    return found


def _walk(root: Params) -> Iterator[_Path]:
    """Yield every element with the elements around it, in document order."""
    waiting: list[_Path] = [(root,)]
    while waiting:
        path = waiting.pop()
        yield path
        waiting.extend((*path, child) for child in reversed(path[-1].children))
