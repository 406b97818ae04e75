"""Parser of `.msg`, `.srv` and `.action` texts that reports every problem of a text with its line.

The rules are those of ROS 2 (https://docs.ros.org/en/jazzy/Concepts/Basic/About-Interfaces.html). The parser needs
neither rosbags nor NumPy.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from simkit.diagnostics import did_you_mean
from simkit.number_text import counted

BASE, NAME, ARRAY, SEQUENCE = 1, 2, 3, 4
"""Kinds of field nodes in the type store: `rosbags.interfaces.Nodetype`, whose import would load all of rosbags."""

# Type of a field: its kind (`BASE`, `NAME`, `ARRAY`, `SEQUENCE`) and the details of that kind.
FieldNode = tuple[int, Any]
Constant = tuple[str, str, Any]

PARTS: Final = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
"""Suffixes of the message types in a definition file, by the kind of the file."""
INTEGER_RANGES: Final[dict[str, tuple[int, int]]] = {
    **{f"int{bits}": (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": (0, (1 << bits) - 1) for bits in (8, 16, 32, 64)},
    "byte": (0, 255),
    "char": (0, 255),
}
TEXTS: Final = frozenset(("string", "wstring"))
BASIC_TYPES: Final = frozenset(("bool", "float32", "float64", *TEXTS, *INTEGER_RANGES))
SYNTAX, BAD_NAME, UNKNOWN_TYPE = "SK-INTERFACE-001", "SK-INTERFACE-002", "SK-INTERFACE-003"

_PACKAGE: Final = re.compile(r"[a-z](?:_?[a-z0-9])*")
_TYPE_NAME: Final = re.compile(r"[A-Z][A-Za-z0-9]*")
_FIELD_NAME: Final = _PACKAGE
_CONSTANT_NAME: Final = re.compile(r"[A-Z](?:[A-Z0-9_]*[A-Z0-9])?")
_FOREIGN_NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_TYPE: Final = re.compile(r"([A-Za-z]\w*(?:/\w+){0,2})(<=\d+)?(\[(<=)?(\d*)\])?", re.ASCII)
_CODE: Final = re.compile(r"""(?:[^#'"]|'(?:\\.|[^'\\])*'|"(?:\\.|[^"\\])*"|['"])*""")
_ITEM: Final = re.compile(r"""\s*+('(?:\\.|[^'\\])*+'|"(?:\\.|[^"\\])*+"|[^,]*+)\s*+(?:,|$)""")
LARGEST_SIZE: Final = (1 << 31) - 1
TYPE_ALIASES: Final = {
    "Header": "std_msgs/msg/Header",
    "time": "builtin_interfaces/msg/Time",
    "duration": "builtin_interfaces/msg/Duration",
}
"""Types by the names that definitions of ROS 1 have for them."""
_OTHER_WORDS: Final = {
    "int": "int32", "float": "float64", "double": "float64", "str": "string", "boolean": "bool", "long": "int64",
    "short": "int16", "unsigned": "uint32", "uint": "uint32", "list": "float64[]", "text": "string",
}  # fmt: skip


@dataclass(frozen=True)
class Problem:
    """Problem of a definition.

    Attributes:
        line: line in the text; 0 for the text as a whole.
    """

    code: str
    line: int
    message: str
    hint: str = ""


@dataclass
class MessageDefinition:
    """Constants and fields of one message type.

    Attributes:
        text: lines of the definition, with comments.
        constants: name, type and value of each constant.
        fields: name and type of each field.
        defaults: default values by the field's name.
        lines: line of each field in the file.
    """

    text: str = ""
    constants: list[Constant] = field(default_factory=list)
    fields: list[tuple[str, FieldNode]] = field(default_factory=list)
    defaults: dict[str, object] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)

    @property
    def content(self) -> tuple[object, ...]:
        """Everything that two equal definitions have in common: not the comments."""
        return self.constants, self.fields, self.defaults

    def used_types(self) -> Iterator[tuple[str, str]]:
        """Yield the name of each field and the message type that it uses."""
        for name, (kind, content) in self.fields:
            inner = content[0] if kind in (ARRAY, SEQUENCE) else (kind, content)
            if inner[0] == NAME:
                yield name, inner[1]


def name_problem(name: str) -> Problem | None:
    """Return the problem of the name of an interface, such as `my_msgs/msg/Num`; None for a valid name."""
    package, kind, short = name.split("/") if name.count("/") == 2 else ("", "", "")
    if kind not in PARTS:
        text = f"{name!r:.80} is not the name of an interface; expected PACKAGE/msg/NAME, /srv/ or /action/"
        return Problem(BAD_NAME, 0, text)
    if not _PACKAGE.fullmatch(package):
        text = f"{package!r:.80} is not the name of a package; expected lower-case letters, digits and single _"
        return Problem(BAD_NAME, 0, text, _suggested(package, _PACKAGE, str.lower))
    if not _TYPE_NAME.fullmatch(short):
        text = f"{short!r:.80} is not the name of a type; expected letters and digits, the first in upper case"
        return Problem(BAD_NAME, 0, text, _suggested(short, _TYPE_NAME, _camel_case))
    return None


def interface_of(type_name: str) -> tuple[str, int] | None:
    """Return the interface that a message type belongs to, and the index of its part; None for a malformed name.

    The type `my_msgs/srv/AddInts_Response` is part 1 of the interface `my_msgs/srv/AddInts`.
    """
    kind = type_name.split("/")[1] if type_name.count("/") == 2 else ""
    for index, suffix in enumerate(PARTS.get(kind, ())):
        if type_name.endswith(suffix):
            return type_name.removesuffix(suffix), index
    return None


def parse_interface(
    name: str, text: str, *, is_foreign: bool = False, is_ros1: bool = False
) -> tuple[list[MessageDefinition], list[Problem]]:
    """Parse the definition of a message, service or action.

    Args:
        name: full name, such as `my_msgs/srv/AddInts`.
        text: content of the file.
        is_foreign: accept names of types, fields and constants that ROS 2 refuses, for definitions in bags.
        is_ros1: accept names of fields and constants that ROS 2 refuses, such as `int64 A`.

    Returns:
        One definition for each part (request and response, for example), and all problems.
    """
    _, kind, _ = name.split("/")
    reader = _Reader(name, is_foreign, has_any_names=is_foreign or is_ros1)
    lines = text.replace("\r\n", "\n").split("\n")
    for number, line in enumerate(lines, 1):
        reader.read(number, line)
    expected, count = len(PARTS[kind]), len(reader.parts)
    if count != expected:
        what = {"msg": "a message has none", "srv": "a service has one", "action": "an action has two"}[kind]
        reader.problem(SYNTAX, 0, f"found {count - 1} separators '---'; {what}")
    for part in reader.parts:
        part.text = part.text.rstrip("\n") + "\n"
    return reader.parts, reader.problems


def names_of_ros1(part: MessageDefinition) -> list[str]:
    """Return the names of fields and constants in a definition that ROS 2 refuses, such as `A` of `int64 A`."""
    fields = [name for name, _ in part.fields if not _FIELD_NAME.fullmatch(name)]
    return fields + [name for name, _, _ in part.constants if not _CONSTANT_NAME.fullmatch(name)]


class _Reader:
    """Reader of the lines of one definition file."""

    def __init__(self, name: str, is_foreign: bool, *, has_any_names: bool) -> None:
        self.package, self.kind, _ = name.split("/")
        self.is_foreign, self._has_any_names = is_foreign, has_any_names
        self.parts = [MessageDefinition()]
        self.problems: list[Problem] = []
        self._names: set[str] = set()

    def problem(self, code: str, line: int, message: str, hint: str = "") -> None:
        self.problems.append(Problem(code, line, message, hint))

    def read(self, number: int, line: str) -> None:
        """Read one line: a separator, a comment, a constant or a field."""
        if line.rstrip() == "---":
            self.parts.append(MessageDefinition())
            self._names = set()
            return
        part = self.parts[-1]
        part.text += line.rstrip() + "\n"
        match = _CODE.match(line)
        code = (match[0] if match else line).strip()
        if not code or code.startswith("@"):  # an annotation such as @verbatim has no effect on messages
            return
        type_text, _, rest = code.replace("\t", " ").partition(" ")
        word = re.match(r"[^\s=]+", rest.lstrip())
        if word is None:
            self.problem(SYNTAX, number, f"found {code!r:.80}; expected TYPE NAME, or TYPE NAME=VALUE for a constant")
            return
        value = rest.lstrip()[word.end() :].strip()
        node = self._node(number, type_text)
        if value.startswith("="):
            self._add_constant(number, node, word[0], value[1:].strip())
        else:
            self._add_field(number, node, word[0], value)

    def _node(self, number: int, text: str) -> FieldNode | None:
        """Return the type of a field; report a problem and return None if it is invalid."""
        match = _TYPE.fullmatch(text)
        if match is None:
            self.problem(SYNTAX, number, f"{text!r:.80} is not a type such as float64, int32[3] or string<=10[]")
            return None
        name, bound, array, is_bound, size = match.groups()
        sizes = [int(number) for number in (bound and bound[2:], size) if number]
        if any(not 0 < number <= LARGEST_SIZE for number in sizes) or (is_bound and not size):
            self.problem(SYNTAX, number, f"{text!r:.80}: a size or bound is a number from 1 to {LARGEST_SIZE}")
            return None
        if bound and name not in TEXTS:
            self.problem(
                SYNTAX, number, f"{text!r:.80}: only string and wstring have a bound", f"write {name}[{bound}]"
            )
            return None
        inner: FieldNode = (BASE, (name, int(bound[2:]) if bound else 0))
        if name not in BASIC_TYPES:
            named = self._type_name(number, name)
            if named is None:
                return None
            inner = (NAME, named)
        if array is None:
            return inner
        return (ARRAY if size and not is_bound else SEQUENCE, (inner, int(size or 0)))

    def _type_name(self, number: int, name: str) -> str | None:
        """Return the full name of the message type of a field; report a problem and return None if it is invalid."""
        if name in TYPE_ALIASES:
            return TYPE_ALIASES[name]
        *packages, short = name.split("/")
        if not self.is_foreign and not _TYPE_NAME.fullmatch(short):
            better = _OTHER_WORDS.get(name, "")
            hint = f"did you mean {better!r}?" if better else did_you_mean(name, BASIC_TYPES)
            self.problem(UNKNOWN_TYPE, number, f"unknown type {name!r:.80}", hint)
            return None
        if packages[1:] not in ([], ["msg"]) and not self.is_foreign:
            self.problem(SYNTAX, number, f"{name!r:.80}: the type of a field is a message, not a {packages[1]}")
            return None
        return f"{packages[0] if packages else self.package}/msg/{short}"

    def _is_valid_name(self, number: int, name: str, pattern: re.Pattern[str], what: str) -> bool:
        pattern = _FOREIGN_NAME if self._has_any_names else pattern
        if not pattern.fullmatch(name):
            case, change = ("upper", str.upper) if pattern is _CONSTANT_NAME else ("lower", _snake_case)
            text = f"{name!r:.80} is not the name of a {what}; expected {case}-case letters, digits and single _"
            self.problem(BAD_NAME, number, text, _suggested(name, pattern, change))
            return False
        if name in self._names:
            self.problem(SYNTAX, number, f"{name!r:.80} is defined twice")
            return False
        self._names.add(name)
        return True

    def _add_constant(self, number: int, node: FieldNode | None, name: str, text: str) -> None:
        is_named = self._is_valid_name(number, name, _CONSTANT_NAME, "constant")
        if node is None:
            return
        if node[0] != BASE:
            self.problem(SYNTAX, number, f"constant {name!r:.80}: expected a basic type such as int32 or string")
            return
        value = self._value(number, node, text, name)
        if value is not None and is_named:
            self.parts[-1].constants.append((name, node[1][0], value))

    def _add_field(self, number: int, node: FieldNode | None, name: str, text: str) -> None:
        if not self._is_valid_name(number, name, _FIELD_NAME, "field") or node is None:
            return
        part = self.parts[-1]
        part.fields.append((name, node))
        part.lines[name] = number
        if text:
            value = self._value(number, node, text, name)
            if value is not None:
                part.defaults[name] = value

    def _value(self, number: int, node: FieldNode, text: str, name: str) -> object:
        """Return the value of a constant or default; report a problem and return None if it is invalid."""
        try:
            return _parse_value(node, text)
        except ValueError as error:
            self.problem(SYNTAX, number, f"{name}: {error}")
            return None


def _parse_value(node: FieldNode, text: str) -> object:
    """Return the value of a text for a field's type.

    Raises:
        ValueError: the text is no value of the type.
    """
    kind, content = node
    if kind == BASE:
        return _scalar(content[0], content[1], text)
    if kind == NAME or content[0][0] == NAME:
        raise ValueError("a field with a message type has no default value")
    inner, size = content
    if not (text.startswith("[") and text.endswith("]")):
        raise ValueError(f"found {text!r:.80}; expected a list such as [1, 2]")
    values = [_parse_value(inner, item) for item in _items(text[1:-1])]
    if (kind == ARRAY and len(values) != size) or (kind == SEQUENCE and size and len(values) > size):
        raise ValueError(
            f"found {counted(len(values), 'value')}; expected {size if kind == ARRAY else f'at most {size}'}"
        )
    return values


def _items(text: str) -> Iterator[str]:
    position = 0 if text.strip() else len(text)
    while position < len(text):
        match = _ITEM.match(text, position)
        if match is None:
            raise ValueError(f"found {text!r:.80}; expected values with commas between them")
        yield match[1].strip()
        position = match.end()


def _scalar(kind: str, bound: int, text: str) -> bool | int | float | str:
    if kind in TEXTS:
        value = _unquoted(text)
        if bound and len(value) > bound:
            raise ValueError(f"found {counted(len(value), 'character')}; expected at most {bound}")
        return value
    if kind == "bool":
        if text.lower() not in ("true", "false", "1", "0"):
            raise ValueError(f"found {text!r:.80}; expected true or false")
        return text.lower() in ("true", "1")
    try:
        if kind.startswith("float"):
            return float(text)
        number = int(text, 10 if re.fullmatch(r"[+-]?\d+", text) else 0)
    except ValueError:
        raise ValueError(f"found {text!r:.80}; expected a value of type {kind}") from None
    low, high = INTEGER_RANGES[kind]
    if not low <= number <= high:
        raise ValueError(f"found {number}; expected a whole number from {low} to {high}")
    return number


def _unquoted(text: str) -> str:
    if len(text) > 1 and text[0] == text[-1] and text[0] in "'\"":
        return re.sub(r"\\(['\"\\])", r"\1", text[1:-1])
    if text[:1] in ("'", '"'):
        raise ValueError(f"found {text!r:.80}; the closing quotation mark is missing")
    return text


def _snake_case(text: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text).lower()


def _camel_case(text: str) -> str:
    return "".join(word[:1].upper() + word[1:] for word in re.split(r"[^A-Za-z0-9]+", text))


def _suggested(name: str, pattern: re.Pattern[str], change: Callable[[str], str]) -> str:
    """Return a hint with the closest valid name."""
    better = re.sub(r"_+", "_", re.sub(r"\W", "_", change(name))).strip("_")
    return f"did you mean {better!r}?" if pattern.fullmatch(better) else ""
