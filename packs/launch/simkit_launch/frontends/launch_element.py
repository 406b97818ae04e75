"""Elements of launch files of ROS 2 in XML or YAML: one tree for both, which knows what was read of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit import Params
from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.input_file import read_failure, read_input_text
from simkit.loaders.resources.xml_reader import parse_file
from simkit.yaml_reader import NotYaml, compose_nodes, node_value
from simkit_launch.frontends.launch_fault import LaunchFault
from simkit_launch.launch_modules.launch.utilities.type_utils import get_typed_value, is_instance_of

if TYPE_CHECKING:
    import yaml

INVALID_ELEMENT: Final = "SK-LAUNCH-023"
INVALID_VALUE: Final = "SK-LAUNCH-025"
UNKNOWN_NAME: Final = "SK-LAUNCH-030"

_ROOT: Final = "launch"
_OF_ROS_1: Final = {"type": "exec", "ns": "namespace", "rosparam": "param", "doc": "description"}
"""Names of ROS 1, with those of ROS 2."""

_TYPE_NAMES: Final = {str: "a text", bool: "true or false", int: "a whole number", float: "a number"}


@dataclass
class LaunchElement:
    """Element of a launch file.

    Attributes:
        name: name of the element, such as `node`.
        where: place in the file.
        values: attributes by name; texts in XML, values of any type in YAML.
        inner: elements inside, by the name that YAML gives to their list; in XML that is their own name.
        children: elements inside in their order; in YAML only those of the list `children`.
        is_yaml: True for YAML, in which values have types.
    """

    name: str
    where: Where
    values: dict[str, Any] = field(default_factory=dict)
    inner: dict[str, list[LaunchElement]] = field(default_factory=dict)
    children: list[LaunchElement] = field(default_factory=list)
    is_yaml: bool = False
    _read: set[str] = field(default_factory=set)
    _has_actions: bool = False

    def value(self, name: str, kind: Any = str, *, can_be_str: bool = True) -> Any:
        """Return the value of an attribute; None without it.

        Args:
            name: name of the attribute.
            kind: type, such as `bool` or `List[float]`; None for the rules of YAML.
            can_be_str: True to keep a text that is not of the type: it may have substitutions.

        Raises:
            LaunchFault: the value is not of the type.
        """
        self._read.add(name)
        if name not in self.values:
            return None
        value = self.values[name]
        if self.is_yaml:
            if not is_instance_of(value, kind, can_be_str=can_be_str):
                raise self._wrong_type(name, value, kind)
            return value
        if f"{name}-sep" in self.values:
            self._read.add(f"{name}-sep")
            value = value.split(self.values[f"{name}-sep"])
        try:
            return get_typed_value(value, kind, can_be_str=can_be_str)
        except (TypeError, ValueError):
            raise self._wrong_type(name, value, kind) from None

    def required_text(self, name: str) -> str:
        """Return the text of an attribute.

        Raises:
            LaunchFault: the attribute is missing, or is no text.
        """
        text = self.value(name)
        if text is None:
            old = next((old for old, now in _OF_ROS_1.items() if now == name and old in self.values), None)
            hint = "" if old is None else f"{old!r} is its name in ROS 1"
            raise LaunchFault(INVALID_ELEMENT, f"the attribute {name!r} is missing", hint)
        return str(text)

    def elements(self, name: str) -> list[LaunchElement]:
        """Return the elements inside with a name."""
        self._read.add(name)
        return self.inner.get(name, [])

    def actions(self) -> list[LaunchElement]:
        """Return the actions inside: all elements in XML that are not read by name, the list `children` in YAML."""
        self._has_actions = True
        return [child for child in self.children if child.name not in self._read]

    def unread_names(self) -> Iterator[tuple[str, Where]]:
        """Yield the attributes and elements that nothing has read, with their places."""
        for name in self.values:
            if name not in self._read:
                yield f"attribute {name!r}", self.where
        for name, elements in self.inner.items():
            if name not in self._read and not self._has_actions:
                kind = f"list {name!r}" if self.is_yaml else f"element <{name}>"
                yield kind, elements[0].where if elements else self.where
        if self.is_yaml and self.children and not self._has_actions:
            yield "list 'children'", self.where

    def report_unread(self, diagnostics: Diagnostics) -> None:
        """Record an error for each attribute and element that nothing has read."""
        for text, where in self.unread_names():
            name = text.split()[1].strip("'<>")
            now = _OF_ROS_1.get(name)
            hint = f"in ROS 2 its name is {now!r}" if now else did_you_mean(name, self._read)
            hint = hint or f"it has {', '.join(sorted(self._read))}"
            diagnostics.error(UNKNOWN_NAME, f"{self.shown} has no {text}", where, hint)

    @property
    def shown(self) -> str:
        """Text of the element for messages."""
        return f"{self.name!r}" if self.is_yaml else f"<{self.name}>"

    def _wrong_type(self, name: str, value: Any, kind: Any) -> LaunchFault:
        text = str(value).lower() if isinstance(value, bool) else value
        hint = f"put it in quotes: {name}: '{text}'" if self.is_yaml and kind is str else ""
        expected = _TYPE_NAMES.get(kind, "a number, a text, true, false, or a list of one of them")
        return LaunchFault(INVALID_VALUE, f"attribute {name!r}: found {value!r}; expected {expected}", hint)


def xml_launch_element(file: Path, diagnostics: Diagnostics) -> LaunchElement | None:
    """Read a launch file in XML; return None, with an error recorded, if it cannot be read."""
    document = parse_file(file, diagnostics)
    return None if document is None else _checked_root(xml_element(document.root), diagnostics)


def xml_element(params: Params) -> LaunchElement:
    """Return an element of XML, with all elements inside."""
    children = [xml_element(child) for child in params.children]
    inner: dict[str, list[LaunchElement]] = {}
    for child in children:
        inner.setdefault(child.name, []).append(child)
    values = {name: text for name, text in params.attributes.items() if ":" not in name and name != "xmlns"}
    return LaunchElement(params.name, params.where, values, inner, children)


def yaml_launch_element(file: Path, diagnostics: Diagnostics) -> LaunchElement | None:
    """Read a launch file in YAML; return None, with an error recorded, if it cannot be read."""
    try:
        node = compose_nodes(read_input_text(file))
    except NotYaml as error:
        diagnostics.error(INVALID_VALUE, f"the launch file is not YAML: {error}", Where(str(file), error.line))
        return None
    except (OSError, UnicodeDecodeError) as error:
        diagnostics.error("SK-LOAD-002", f"cannot read the file: {read_failure(error)}", Where(str(file)))
        return None
    reader = _YamlReader(str(file), diagnostics)
    pairs = list(reader.pairs(node)) if node is not None else []
    if len(pairs) != 1:
        found = ", ".join(repr(name) for name, _ in pairs) or "none"
        message = f"found the outermost keys {found}; a launch file has the one key 'launch'"
        diagnostics.error(INVALID_ELEMENT, message, Where(str(file), 1))
        return None
    return _checked_root(reader.element(*pairs[0]), diagnostics)


def _checked_root(root: LaunchElement, diagnostics: Diagnostics) -> LaunchElement | None:
    if root.name == _ROOT:
        return root
    message = f"found the outermost element {root.name!r}; a launch file has 'launch'"
    diagnostics.error(INVALID_ELEMENT, message, root.where, did_you_mean(root.name, [_ROOT]))
    return None


class _YamlReader:
    """Reader of the nodes of a YAML text."""

    def __init__(self, file: str, diagnostics: Diagnostics) -> None:
        self.file, self.diagnostics = file, diagnostics

    def pairs(self, node: yaml.Node) -> Iterator[tuple[str, yaml.Node]]:
        """Yield the keys and values of a mapping; anything else has none."""
        for key, value in node.value if _kind(node) == "mapping" else ():
            yield str(key.value), value

    def element(self, name: str, node: yaml.Node) -> LaunchElement:
        """Return the element of a key and its value."""
        where = Where(self.file, node.start_mark.line + 1)
        element = LaunchElement(name, where, is_yaml=True)
        if _kind(node) == "sequence":
            element.children = list(self._children(node.value))
        for key, value in self.pairs(node):
            if key == "children" and _kind(value) == "sequence":
                element.children = list(self._children(value.value))
            elif _kind(value) == "sequence" and value.value and _kind(value.value[0]) == "mapping":
                element.inner[key] = [self.element(key, item) for item in value.value]
            else:
                try:
                    element.values[key] = node_value(value)
                except NotYaml as error:
                    place = Where(self.file, value.start_mark.line + 1)
                    self.diagnostics.error(INVALID_VALUE, f"{key!r}: {error}", place)
        if _kind(node) == "scalar" and node.value:
            message = f"found {name}: {node.value}; expected a mapping or a list"
            self.diagnostics.error(INVALID_ELEMENT, message, where)
        return element

    def _children(self, nodes: Iterable[yaml.Node]) -> Iterator[LaunchElement]:
        for node in nodes:
            pairs = list(self.pairs(node))
            if len(pairs) == 1:
                yield self.element(*pairs[0])
            else:
                found = ", ".join(name for name, _ in pairs) or "no key"
                message = f"found {found}; each item of the list has one key, such as 'node', with its values below it"
                hint = "indent the values more than the key" if len(pairs) > 1 else ""
                self.diagnostics.error(INVALID_ELEMENT, message, Where(self.file, node.start_mark.line + 1), hint)


def _kind(node: yaml.Node) -> str:
    """Return "mapping", "sequence" or "scalar"."""
    return str(getattr(node, "id", ""))
