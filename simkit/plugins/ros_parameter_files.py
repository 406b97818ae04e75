"""Parameter files of ROS: YAML in, one block of typed parameters for each node out, every value with its line.

ROS 2's layout has `ros__parameters` below the name of a node, which may be a pattern (`/**`, `/robot/*`); ROS 1's has
the parameters themselves below the names of namespaces. Which of the two a file is in shows by that word.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import yaml

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params
from simkit.plugins.ros_parameter_block import Form, ParameterBlock

PARAMETERS: Final = "ros__parameters"
_MOST_NODES: Final = 100_000  # of one file: anchors that are used again and again make much out of little
_DEEPEST: Final = 100
_MERGE: Final = "tag:yaml.org,2002:merge"


@dataclass(slots=True)
class Entry:
    """A key of a parameter file: a value, a list of values, or a block.

    Attributes:
        text: of a value, normalised (`true`, `inf`).
        items: of a list; None where it is none.
        below: of a block; None where it is none.
        is_text: whether it stands for text, so that no number is meant.
    """

    where: Where
    text: str = ""
    items: list[Entry] | None = None
    below: dict[str, Entry] | None = None
    is_text: bool = False

    def params(self, name: str, diagnostics: Diagnostics) -> list[Params]:
        """It as elements of that name: one, or one for each item of a list."""
        if self.items is not None:
            return [one for item in self.items for one in item.item(name, diagnostics)]
        return [self.block(name, diagnostics)]

    def item(self, name: str, diagnostics: Diagnostics) -> list[Params]:
        """It as an item of the list of that name; a list is none."""
        if self.items is None:
            return [self.block(name, diagnostics)]
        diagnostics.error("SK-CONTROL-002", f"found a list in the list {name!r}, allowed are values", self.where)
        return []

    def block(self, name: str, diagnostics: Diagnostics) -> ParameterBlock:
        """It as one element of that name."""
        below = self.below or {}
        children = [one for key, entry in below.items() for one in entry.params(key, diagnostics)]
        forms = {key: (entry.form, entry.where) for key, entry in below.items()}
        is_block = self.below is not None
        return ParameterBlock(name, self.text, children, self.where, diagnostics, forms, is_block=is_block)

    @property
    def form(self) -> Form:
        """Form in which the file has it."""
        if self.items is not None:
            return "list"
        if self.below is not None:
            return "block"
        return "value" if self.text or self.is_text else "nothing"

    def merged(self, over: Entry) -> Entry:
        """It with what another says about the same key, which goes over it."""
        if self.below is None or over.below is None:
            return over
        below = dict(self.below)
        for key, entry in over.below.items():
            below[key] = below[key].merged(entry) if key in below else entry
        return Entry(self.where, below=below)

    def leaves(self) -> int:
        """Count the values in it."""
        inside = [*(self.items or ()), *(self.below or {}).values()]
        return sum(one.leaves() for one in inside) if inside else 1


@dataclass(slots=True)
class ParameterFile:
    """One file as read.

    Attributes:
        path: of the file.
        nodes: ROS 2: (pattern of the node's full name, its parameters), in the order of the file.
        root: ROS 1: everything; None for ROS 2.
    """

    path: Path
    nodes: list[tuple[str, Entry]] = field(default_factory=list)
    root: Entry | None = None


class ParameterFiles:
    """All parameter files of one plugin; what a later one says goes over what an earlier one says."""

    def __init__(self, files: Sequence[ParameterFile] = ()) -> None:
        self.files = list(files)

    def __deepcopy__(self, memo: dict[int, object]) -> ParameterFiles:
        return self  # nothing in it changes

    def of_node(self, name: str) -> Entry | None:
        """The parameters of the node with that full name (`/robot/arm_controller`); None where no file has any."""
        found: Entry | None = None
        for entry in self._of_node(name):
            found = entry if found is None else found.merged(entry)
        return found

    def _of_node(self, name: str) -> Iterator[Entry]:
        for file in self.files:
            for pattern, entry in file.nodes:
                if node_matches(pattern, name):
                    yield entry
            if file.root is not None:
                inner: Entry | None = file.root
                for part in name.strip("/").split("/"):
                    inner = (inner.below or {}).get(part) if inner is not None and part else inner
                if inner is not None and inner.below is not None:
                    yield inner

    def node_names(self) -> list[str]:
        """Last parts of the names that the files have parameters for, to say which is near a misspelt one."""
        return [pattern.rpartition("/")[2] for file in self.files for pattern, _ in file.nodes]


def node_matches(pattern: str, name: str) -> bool:
    """Check whether a node's full name matches a key of a parameter file: `*` is one part, `**` any number of parts."""
    return _node_pattern(pattern).fullmatch(name.strip("/")) is not None


@functools.lru_cache(maxsize=1024)
def _node_pattern(pattern: str) -> re.Pattern[str]:
    parts = [".*" if p == "**" else "[^/]*" if p == "*" else re.escape(p) for p in pattern.strip("/").split("/")]
    return re.compile("/".join(parts).replace(".*/", "(.*/)?"))


def read_parameter_file(path: Path, diagnostics: Diagnostics) -> ParameterFile | None:
    """Reads a file; None after an error that says where it is broken."""
    root = _parse_file(path, diagnostics)
    if root is None:
        return None
    if root.below is None:
        if root.text or root.items:
            message = f"{path.name} is no parameter file: names of nodes are needed at its top"
            diagnostics.error("SK-CONTROL-002", message, root.where)
            return None
        diagnostics.warning("SK-CONTROL-003", f"{path.name} is empty: no controller is loaded", root.where)
        return ParameterFile(path)
    nodes = list(_nodes(root, "", diagnostics))
    if nodes:
        return ParameterFile(path, nodes)
    near = next((near for key in _all_keys(root) if (near := did_you_mean(key, [PARAMETERS]))), "")
    if near:
        misspelt = next(key for key in _all_keys(root) if did_you_mean(key, [PARAMETERS]))
        message = f"{path.name}: no node has {PARAMETERS!r}, but there is {misspelt!r}; it is read as a file of ROS 1"
        diagnostics.warning("SK-CONTROL-003", message, root.where, near)
    return ParameterFile(path, root=root)


def _all_keys(entry: Entry) -> Iterator[str]:
    for key, below in (entry.below or {}).items():
        yield key
        yield from _all_keys(below)


def _nodes(entry: Entry, path: str, diagnostics: Diagnostics) -> Iterator[tuple[str, Entry]]:
    """Every node of a file in ROS 2's layout, with the pattern of its full name."""
    for key, below in (entry.below or {}).items():
        if key == PARAMETERS:
            if below.below is not None:
                yield path or "/**", _expand_dotted_keys(below)
            elif below.text or below.items:
                found = below.text or "a list"
                message = f"found {found!r} under {PARAMETERS!r} of {path or '/**'!r}, allowed are names with values"
                diagnostics.error("SK-CONTROL-002", message, below.where)
        else:
            yield from _nodes(below, f"{path}/{key.strip('/')}", diagnostics)


def _expand_dotted_keys(entry: Entry) -> Entry:
    """A block with its dotted keys as the blocks that they stand for: `a.b: 1` is `a: {b: 1}`."""
    if entry.below is None:
        return entry
    whole = Entry(entry.where, below={})
    for key, below in entry.below.items():
        inner = _expand_dotted_keys(below)
        for part in reversed(key.split(".")):
            inner = Entry(below.where, below={part: inner})
        whole = whole.merged(inner)
    return whole


# ------------------------------------------------------------------ YAML


def _parse_file(path: Path, diagnostics: Diagnostics) -> Entry | None:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        diagnostics.error("SK-CONTROL-002", f"{path} cannot be read: {error}", Where(str(path)))
        return None
    except UnicodeDecodeError as error:
        where = Where(str(path), error.object.count(b"\n", 0, error.start) + 1)
        diagnostics.error("SK-CONTROL-002", f"{path.name} cannot be read: {error}", where, "save it as UTF-8")
        return None
    try:
        node = _compose_yaml(text)
        reader = _EntryReader(str(path), diagnostics)
        return Entry(Where(str(path), 1)) if node is None else reader.entry(node, 0)
    except (yaml.YAMLError, RecursionError, _FileTooLarge) as error:
        mark = getattr(error, "problem_mark", None)
        line = mark.line + 1 if mark is not None else None
        what = getattr(error, "problem", None) or str(error) or "it is nested too deeply"
        if isinstance(error, yaml.reader.ReaderError):  # it knows the character's place alone
            line, what = text.count("\n", 0, error.position) + 1, f"the character {chr(error.character)!r} is not text"
        context = f" {error.context}" if getattr(error, "context", None) else ""  # type: ignore[union-attr]
        message = f"{path.name} is not YAML that can be read: {what}{context}"
        diagnostics.error("SK-CONTROL-002", message, Where(str(path), line), "check indentation, quotes and brackets")
        return None


def _compose_yaml(text: str) -> yaml.Node | None:
    """The tree of a document; by libyaml where it is there, which takes a tenth of the time."""
    loader: type[yaml.SafeLoader] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    depth = 0
    for event in yaml.parse(text, Loader=loader):  # libyaml's own composer has no end to its recursion
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > _DEEPEST:
            raise _FileTooLarge("it is nested too deeply")
    return yaml.compose(text, Loader=loader)


class _FileTooLarge(Exception):
    """A file is larger than anybody means."""


class _EntryReader:
    """Turns YAML's nodes into entries."""

    def __init__(self, file: str, diagnostics: Diagnostics) -> None:
        self._file, self._diagnostics, self._count = file, diagnostics, 0

    def entry(self, node: yaml.Node, depth: int) -> Entry:
        self._count += 1
        if self._count > _MOST_NODES or depth > _DEEPEST:
            raise _FileTooLarge("it has too many values, or is nested too deeply")
        where = Where(self._file, node.start_mark.line + 1, self._count)
        if isinstance(node, yaml.MappingNode):
            return Entry(where, below=self._block(node, depth))
        if isinstance(node, yaml.SequenceNode):
            return Entry(where, items=[self.entry(one, depth + 1) for one in node.value])
        return Entry(where, _value_text(node), is_text=node.tag == "tag:yaml.org,2002:str")

    def _block(self, node: yaml.MappingNode, depth: int) -> dict[str, Entry]:
        below: dict[str, Entry] = {}
        merged: dict[str, Entry] = {}
        for key, value in node.value:
            name = str(getattr(key, "value", ""))
            if not name or not isinstance(getattr(key, "value", None), str):
                where = Where(self._file, key.start_mark.line + 1)
                found = "an empty name" if not name else "a list or block as a name"
                self._diagnostics.error("SK-CONTROL-002", f"found {found}, allowed is a text", where)
                continue
            entry = self.entry(value, depth + 1)
            if key.tag == _MERGE:
                merged = {**self._merged(entry, key), **merged}
                continue
            entry.where = Where(self._file, key.start_mark.line + 1, entry.where.serial)
            if name in below:
                first = below[name].where.line
                message = f"{name!r} comes twice, in line {first} too; the later one counts"
                self._diagnostics.warning("SK-CONTROL-004", message, entry.where)
            below[name] = entry
        return {**merged, **below}

    def _merged(self, entry: Entry, key: yaml.Node) -> dict[str, Entry]:
        """Return what `<<` merges: the names of a block, or of several, the first of which counts."""
        found: dict[str, Entry] = {}
        for one in [entry] if entry.items is None else entry.items:
            if one.below is None:
                where = Where(self._file, key.start_mark.line + 1)
                self._diagnostics.error("SK-CONTROL-002", "found a value after '<<', allowed is a block", where)
            found = {**(one.below or {}), **found}
        return found


def _value_text(node: yaml.Node) -> str:
    """A value as parameters have it."""
    kind, text = node.tag.rpartition(":")[2], str(node.value)
    if kind == "null":
        return ""
    if kind == "bool":
        return "true" if text.lower() in ("true", "yes", "on") else "false"
    if kind == "float":
        return text.lower().replace(".inf", "inf").replace(".nan", "nan").replace("_", "")
    if kind == "int":
        plain = text.replace("_", "")
        try:
            return str(int(plain, 0))
        except ValueError:
            return plain.lstrip("0") or "0"
    return text
