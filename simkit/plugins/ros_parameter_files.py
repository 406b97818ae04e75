"""Parameter files of ROS: convert YAML to typed parameters of each node, and store the line of every value.

In ROS 2's layout, a block has the name of a node, or a pattern such as `/**` or `/robot/*`, and contains the block
`ros__parameters`. In ROS 1's layout, blocks have the names of namespaces and contain the parameters directly. A file
without the word `ros__parameters` is read in ROS 1's layout.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import yaml

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.input_file import read_failure, read_input_text
from simkit.params import Params
from simkit.plugins.ros_parameter_block import Form, ParameterBlock

PARAMETERS: Final = "ros__parameters"
_MOST_NODES: Final = 100_000  # limit for one file, because repeated YAML anchors can make a short file very large
_DEEPEST: Final = 100
_MERGE: Final = "tag:yaml.org,2002:merge"


@dataclass(slots=True)
class Entry:
    """Value, list or block of a parameter file.

    Attributes:
        where: file and line.
        text: text of a value, in a normalised spelling such as `true` or `inf`.
        items: entries of a list; None for a value or block.
        below: entries of a block; None for a value or list.
        is_text: whether the value is a string in YAML.
    """

    where: Where
    text: str = ""
    items: list[Entry] | None = None
    below: dict[str, Entry] | None = None
    is_text: bool = False

    def params(self, name: str, diagnostics: Diagnostics) -> list[Params]:
        """Return the entry as elements with the given name: one element for each item of a list, otherwise one."""
        if self.items is not None:
            return [params for item in self.items for params in item.item(name, diagnostics)]
        return [self.block(name, diagnostics)]

    def item(self, name: str, diagnostics: Diagnostics) -> list[Params]:
        """Return the entry as an item of the list with the given name; an item that is itself a list is an error."""
        if self.items is None:
            return [self.block(name, diagnostics)]
        diagnostics.error("SK-CONTROL-002", f"found a list in the list {name!r}; expected values", self.where)
        return []

    def block(self, name: str, diagnostics: Diagnostics) -> ParameterBlock:
        """Return the entry, a value or block, as an element with the given name."""
        below = self.below or {}
        children = [params for key, entry in below.items() for params in entry.params(key, diagnostics)]
        forms = {key: (entry.form, entry.where) for key, entry in below.items()}
        is_block = self.below is not None
        return ParameterBlock(name, self.text, children, self.where, diagnostics, forms, is_block=is_block)

    @property
    def form(self) -> Form:
        """Form of the entry: list, block, value, or nothing after the colon."""
        if self.items is not None:
            return "list"
        if self.below is not None:
            return "block"
        return "value" if self.text or self.is_text else "nothing"

    def merged(self, over: Entry) -> Entry:
        """Return this entry merged with `over`; where both have a value, the value and the place of `over` are used.

        A mapping that two files have is that of `over`; within a file, it keeps the line at which it begins.
        """
        if self.below is None or over.below is None:
            return over
        below = dict(self.below)
        for key, entry in over.below.items():
            below[key] = below[key].merged(entry) if key in below else entry
        return Entry(self.where if self.where.file == over.where.file else over.where, below=below)

    def leaves(self) -> int:
        """Count the values in the entry."""
        inside = [*(self.items or ()), *(self.below or {}).values()]
        return sum(item.leaves() for item in inside) if inside else 1


@dataclass(slots=True)
class ParameterFile:
    """Contents of a parameter file.

    Attributes:
        path: path of the file.
        nodes: in ROS 2's layout, pairs of a pattern for the full name of a node and the parameters, in file order.
        root: in ROS 1's layout, all parameters; None in ROS 2's layout.
    """

    path: Path
    nodes: list[tuple[str, Entry]] = field(default_factory=list)
    root: Entry | None = None


class ParameterFiles:
    """Parameter files of one plugin; values of a later file replace those of an earlier one."""

    def __init__(self, files: Sequence[ParameterFile] = ()) -> None:
        self.files = tuple(files)
        # each controller is looked for while each other one is loaded
        self._nodes: dict[str, Entry | None] = {}
        self._names_below: dict[str, tuple[str, ...]] = {}

    def __deepcopy__(self, memo: dict[int, object]) -> ParameterFiles:
        return self  # the object never changes

    def of_node(self, name: str) -> Entry | None:
        """Return the parameters of a node by its full name, such as `/robot/arm_controller`; None if there are none."""
        if name not in self._nodes:
            parameters: Entry | None = None
            for entry in self._of_node(name):
                parameters = entry if parameters is None else parameters.merged(entry)
            self._nodes[name] = parameters
        return self._nodes[name]

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

    def nodes_below(self, namespace: str) -> tuple[str, ...]:
        """Return the plain names of the nodes of a namespace that the files name without a wildcard, in file order."""
        if namespace not in self._names_below:
            self._names_below[namespace] = tuple(self._nodes_below(namespace))
        return self._names_below[namespace]

    def _nodes_below(self, namespace: str) -> Iterator[str]:
        names = (pattern.rpartition("/")[2] for file in self.files for pattern, _ in file.nodes)
        for name in dict.fromkeys(name for name in names if "*" not in name):
            if any(node_matches(p, f"{namespace}/{name}") for file in self.files for p, _ in file.nodes if name in p):
                yield name

    def node_names(self) -> list[str]:
        """Return the plain names of all nodes in the files, as suggestions for a misspelt name."""
        return [pattern.rpartition("/")[2] for file in self.files for pattern, _ in file.nodes]


def node_matches(pattern: str, name: str) -> bool:
    """Check whether a node's full name matches a pattern: `*` is one part of the name, `**` any number of parts."""
    if "*" not in pattern:
        return pattern.strip("/") == name.strip("/")
    parts, wanted = name.strip("/").split("/"), pattern.strip("/").split("/")
    ends = {0}  # numbers of parts of the name that the pattern can have matched so far
    for number, part in enumerate(wanted, 1):
        if part != "**":
            ends = {end + 1 for end in ends if end < len(parts) and part in ("*", parts[end])}
        elif number == len(wanted):  # at the end, at least one part
            ends = {len(parts)} if min(ends) < len(parts) else set()
        else:
            ends = set(range(min(ends), len(parts) + 1))
        if not ends:
            return False
    return len(parts) in ends


def read_parameter_file(path: Path, diagnostics: Diagnostics) -> ParameterFile | None:
    """Read a parameter file; return None after an error, which is reported at the faulty line."""
    root = _parse_file(path, diagnostics)
    if root is None:
        return None
    if root.below is None:
        if root.text or root.items:
            message = f"{path.name} is not a parameter file: the keys at its top level must be names of nodes"
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
        message = f"{path.name}: no node has {PARAMETERS!r}, but {misspelt!r} occurs; the file is read as a ROS 1 file"
        diagnostics.warning("SK-CONTROL-003", message, root.where, near)
    return ParameterFile(path, root=root)


def parse_parameter(name: str, text: str, where: Where, diagnostics: Diagnostics) -> Entry | None:
    """Return a block with one parameter from a text such as that after `-p name:=`; None after an error."""
    try:
        node = _compose_yaml(text)
        reader = _EntryReader(where.file or "", diagnostics, merges_blocks=True, first_line=where.line or 1)
        value = Entry(where) if node is None else reader.entry(node, 0)
    except (yaml.YAMLError, RecursionError, _FileTooLarge):
        diagnostics.error("SK-PARAM-002", f"found {text[:200]!r} for parameter {name!r}; expected a YAML value", where)
        return None
    return _expand_dotted_keys(Entry(where, below={name: value}))


def _all_keys(entry: Entry) -> Iterator[str]:
    for key, below in (entry.below or {}).items():
        yield key
        yield from _all_keys(below)


def _nodes(entry: Entry, path: str, diagnostics: Diagnostics) -> Iterator[tuple[str, Entry]]:
    """Yield the pattern of the full name and the parameters of each node in a file with ROS 2's layout."""
    for key, below in (entry.below or {}).items():
        if key == PARAMETERS:
            if below.below is not None:
                yield path or "/**", _expand_dotted_keys(below)
            elif below.text or below.items:
                content = below.text or "a list"
                message = f"found {content!r} under {PARAMETERS!r} of {path or '/**'!r}; expected names with values"
                diagnostics.error("SK-CONTROL-002", message, below.where)
        else:
            yield from _nodes(below, f"{path}/{key.strip('/')}", diagnostics)


def _expand_dotted_keys(entry: Entry) -> Entry:
    """Return a block without dotted keys: `a.b: 1` becomes `a: {b: 1}`. `_EntryReader` limits the depth."""
    if entry.below is None:
        return entry
    expanded = Entry(entry.where, below={})
    for key, below in entry.below.items():
        inner = _expand_dotted_keys(below)
        for part in reversed(key.split(".")):
            inner = Entry(below.where, below={part: inner})
        expanded = expanded.merged(inner)
    return expanded


# ------------------------------------------------------------------ YAML


def _parse_file(path: Path, diagnostics: Diagnostics) -> Entry | None:
    try:
        text = read_input_text(path)
    except OSError as error:
        diagnostics.error("SK-CONTROL-002", f"{path} cannot be read: {read_failure(error)}", Where(str(path)))
        return None
    except UnicodeDecodeError as error:
        where = Where(str(path), error.object.count(b"\n", 0, error.start) + 1)
        diagnostics.error("SK-CONTROL-002", f"{path.name} cannot be read: {error}", where, "save it as UTF-8")
        return None
    try:
        node = _compose_yaml(text)
        reader = _EntryReader(str(path), diagnostics, merges_blocks=PARAMETERS in text)
        return Entry(Where(str(path), 1)) if node is None else reader.entry(node, 0)
    except (yaml.YAMLError, RecursionError, _FileTooLarge) as error:
        mark = getattr(error, "problem_mark", None)
        line = mark.line + 1 if mark is not None else None
        what = getattr(error, "problem", None) or str(error) or "it is nested too deeply"
        if isinstance(error, yaml.reader.ReaderError):  # a ReaderError has no line number
            line = text.count("\n", 0, error.position) + 1
            what = f"the character {chr(error.character)!r} is not allowed"
        context = f" {error.context}" if getattr(error, "context", None) else ""  # type: ignore[union-attr]
        message = f"{path.name} is not valid YAML: {what}{context}"
        diagnostics.error("SK-CONTROL-002", message, Where(str(path), line), "check indentation, quotes and brackets")
        return None


def _compose_yaml(text: str) -> yaml.Node | None:
    """Return the syntax tree of a YAML document; libyaml is used if it is available, because it is ten times faster."""
    loader: type[yaml.SafeLoader] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    depth = 0
    for event in yaml.parse(text, Loader=loader):  # libyaml's composer accepts any nesting depth
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > _DEEPEST:
            raise _FileTooLarge("it is nested too deeply")
    return yaml.compose(text, Loader=loader)


class _FileTooLarge(Exception):
    """Parameter file with too many values or too deep nesting."""


class _EntryReader:
    """Converter from YAML nodes to entries.

    Args:
        file: path of the file.
        diagnostics: collector of the problems.
        merges_blocks: whether blocks with the same name are merged, as rcl does; PyYAML, which ROS 1 uses, keeps only
            the last block.
        first_line: line of the file in which the text begins.
    """

    def __init__(self, file: str, diagnostics: Diagnostics, *, merges_blocks: bool, first_line: int = 1) -> None:
        self._file, self._diagnostics, self._merges_blocks = file, diagnostics, merges_blocks
        self._first_line, self._count = first_line, 0

    def entry(self, node: yaml.Node, depth: int) -> Entry:
        self._count += 1
        if self._count > _MOST_NODES or depth > _DEEPEST:
            raise _FileTooLarge("it has too many values, or is nested too deeply")
        where = Where(self._file, node.start_mark.line + self._first_line, self._count)
        if isinstance(node, yaml.MappingNode):
            return Entry(where, below=self._block(node, depth))
        if isinstance(node, yaml.SequenceNode):
            return Entry(where, items=[self.entry(item, depth + 1) for item in node.value])
        return Entry(where, _value_text(node), is_text=node.tag == "tag:yaml.org,2002:str")

    def _block(self, node: yaml.MappingNode, depth: int) -> dict[str, Entry]:
        below: dict[str, Entry] = {}
        merged: dict[str, Entry] = {}
        for key, value in node.value:
            name = str(getattr(key, "value", ""))
            if key.value == "" and isinstance(value, yaml.MappingNode):  # rosparam ignores an empty part of a name
                for inner, entry in self._block(value, depth + 1).items():
                    below[inner] = self._with_repeated(below[inner], entry, inner) if inner in below else entry
                continue
            if not name or not isinstance(getattr(key, "value", None), str):
                where = Where(self._file, key.start_mark.line + self._first_line)
                problem = "an empty name" if not name else "a list or block as a name"
                self._diagnostics.error("SK-CONTROL-002", f"found {problem}; expected a text", where)
                continue
            entry = self.entry(value, depth + 1 + name.count("."))  # a dotted key stands for several levels
            if key.tag == _MERGE:
                merged = {**self._merged(entry, key), **merged}
                continue
            entry.where = Where(self._file, key.start_mark.line + self._first_line, entry.where.serial)
            below[name] = self._with_repeated(below[name], entry, name) if name in below else entry
        return {**merged, **below}

    def _with_repeated(self, first: Entry, later: Entry, name: str) -> Entry:
        """Return the entry of a key that occurs twice: merged blocks in ROS 2's layout, otherwise the later value."""
        if self._merges_blocks and first.below is not None and later.below is not None:
            below = dict(first.below)
            for key, entry in later.below.items():
                below[key] = self._with_repeated(below[key], entry, key) if key in below else entry
            return Entry(first.where, below=below)
        message = f"{name!r} occurs twice, first in line {first.where.line}; the later value is used"
        self._diagnostics.warning("SK-CONTROL-004", message, later.where)
        return later

    def _merged(self, entry: Entry, key: yaml.Node) -> dict[str, Entry]:
        """Return the entries that the key `<<` merges, from one block or a list of blocks.

        If several blocks have the same key, the first block is used.
        """
        merged: dict[str, Entry] = {}
        for item in [entry] if entry.items is None else entry.items:
            if item.below is None:
                where = Where(self._file, key.start_mark.line + self._first_line)
                self._diagnostics.error("SK-CONTROL-002", "found a value after '<<'; expected a block", where)
            merged = {**(item.below or {}), **merged}
        return merged


def _value_text(node: yaml.Node) -> str:
    """Return the text of a YAML value in the form that `Params` parses."""
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
