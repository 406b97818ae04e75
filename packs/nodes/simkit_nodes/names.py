"""Names of ROS 2: their rules, expansion and remapping, and the arguments after `--ros-args`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple

MAX_NAME: Final = 255
"""Largest length of the name of a node."""

MAX_NAMESPACE: Final = 245
"""Largest length of a namespace."""

NameFault = tuple[str, int]
"""Text of an error in a name, and the index at which it is."""

_NOT_IN_NAME = re.compile(r"[^A-Za-z0-9_]")
_NOT_IN_FULL_NAME = re.compile(r"[^A-Za-z0-9_/]")
_UNBALANCED: Final = "topic name must not have unmatched (unbalanced) curly braces '{}'"
_BAD_SUBSTITUTION: Final = "substitution name must not contain characters other than alphanumerics or '_'"
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_PART = r"([A-Za-z_]\w*|/([A-Za-z_]\w*)?)(/([A-Za-z_]\w*)?)*"
_PARAMETER_NAME = re.compile(rf"{_PART}(\.{_PART})*", re.ASCII)  # as rcl reads it after `-p`


class RosArgumentsError(ValueError):
    """Error in the arguments after `--ros-args`."""


class UnknownArgumentsError(RosArgumentsError):
    """Unknown arguments after `--ros-args`."""


def node_name_error(name: str) -> NameFault | None:
    """Return what is wrong with the name of a node; None for a valid name."""
    if not name:
        return "node name must not be empty", 0
    if match := _NOT_IN_NAME.search(name):
        return "node name must not contain characters other than alphanumerics or '_'", match.start()
    if name[0].isdigit():
        return "node name must not start with a number", 0
    if len(name) > MAX_NAME:
        return f"node name length should not exceed '{MAX_NAME}'", MAX_NAME - 1
    return None


def namespace_error(namespace: str) -> NameFault | None:
    """Return what is wrong with an absolute namespace; None for a valid one."""
    if not namespace:
        return "namespace must not be empty", 0
    if namespace[0] != "/":
        return "namespace must be absolute, it must lead with a '/'", 0
    if len(namespace) == 1:
        return None
    if namespace[-1] == "/":
        return "namespace must not end with a '/', unless only a '/'", len(namespace) - 1
    if match := _NOT_IN_FULL_NAME.search(namespace):
        return "namespace must not contain characters other than alphanumerics, '_', or '/'", match.start()
    if (index := namespace.find("//")) >= 0:
        return "namespace must not contain repeated '/'", index + 1
    if match := re.search(r"/[0-9]", namespace):
        return "namespace must not have a token that starts with a number", match.start() + 1
    if len(namespace) > MAX_NAMESPACE:
        return "namespace should not exceed 'RMW_NAMESPACE_MAX_NAME_LENGTH'", MAX_NAMESPACE - 1
    return None


def topic_name_error(name: str) -> NameFault | None:
    """Return what is wrong with the name of a topic or service as a program writes it; None for a valid name."""
    if not name:
        return "topic name must not be empty string", 0
    if name[0].isdigit():
        return "topic name token must not start with a number", 0
    if name[-1] == "/":
        return "topic name must not end with a forward slash", len(name) - 1
    depth = start = 0
    for index, letter in enumerate(name):
        if letter.isascii() and (letter.isalnum() or letter == "_"):
            if letter.isdigit() and depth and index and name[index - 1] == "{":
                return "substitution name must not start with a number", index
            continue
        if letter == "/":
            if depth:
                return _BAD_SUBSTITUTION, index
            continue
        if letter == "~":
            if index:
                return "topic name must not have tilde '~' unless it is the first character", index
            continue
        if letter == "{":
            depth += 1
            if depth > 1:
                return _BAD_SUBSTITUTION, index
            start = index
            continue
        if letter == "}":
            depth -= 1
            if depth < 0:
                return _UNBALANCED, index
            continue
        if depth:
            return _BAD_SUBSTITUTION, index
        return "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'", index
    if depth:
        return _UNBALANCED, start
    for index in range(len(name) - 1):
        if name[index] == "/" and name[index + 1].isdigit():
            return "topic name token must not start with a number", index + 1
    return None


def full_topic_name_error(name: str) -> NameFault | None:
    """Return what is wrong with the absolute name of a topic or service; None for a valid name."""
    if not name:
        return "topic name must not be empty", 0
    if name[0] != "/":
        return "topic name must be absolute, it must lead with a '/'", 0
    if name[-1] == "/":
        return "topic name must not end with a '/'", len(name) - 1
    if match := _NOT_IN_FULL_NAME.search(name):
        return "topic name must not contain characters other than alphanumerics, '_', or '/'", match.start()
    if (index := name.find("//")) >= 0:
        return "topic name must not contain repeated '/'", index + 1
    if match := re.search(r"/[0-9]", name):
        return "topic name must not have a token that starts with a number", match.start() + 1
    return None


def join_name(namespace: str, name: str) -> str:
    """Return a name in a namespace; an absolute name stays as it is."""
    return name if name.startswith("/") else f"{namespace.rstrip('/')}/{name}"


def expand_name(name: str, node: str, namespace: str) -> str:
    """Return the absolute name of a topic or service, without remapping.

    Args:
        name: name as a program writes it: absolute, relative, or private with `~`.
        node: name of the node, without its namespace.
        namespace: absolute namespace of the node.

    Raises:
        ValueError: the name has an unknown substitution in braces.
    """
    if name.startswith("~"):
        name = join_name(namespace, node) + name[1:]
    values = {"node": node, "ns": namespace, "namespace": namespace}

    def value_of(match: re.Match[str]) -> str:
        if match[1] not in values:
            raise ValueError(f"unknown substitution: {match[0]}")
        return values[match[1]]

    return join_name(namespace, _SUBSTITUTION.sub(value_of, name))


class RemapRule(NamedTuple):
    """Rule that gives a new name.

    Attributes:
        node: name of the node to which the rule applies; empty for every node.
        kind: names to which the rule applies.
        old: old name; empty for the name or the namespace of a node.
        new: new name.
    """

    node: str
    kind: Literal["any", "topic", "service", "node_name", "namespace"]
    old: str
    new: str


@dataclass
class RosArguments:
    """Arguments after `--ros-args`.

    Attributes:
        rules: rules for names; the first one that applies counts.
        parameters: pattern of a node's name, name and value as YAML of each `-p`.
        parameter_files: paths of `--params-file`.
        levels: levels of loggers by name; the name is empty for the default level.
        is_rosout_enabled: False after `--disable-rosout-logs`.
        is_stdout_enabled: False after `--disable-stdout-logs`.
        others: arguments that are not for ROS.
    """

    rules: list[RemapRule] = field(default_factory=list)
    parameters: list[tuple[str, str, str]] = field(default_factory=list)
    parameter_files: list[str] = field(default_factory=list)
    levels: dict[str, str] = field(default_factory=dict)
    is_rosout_enabled: bool = True
    is_stdout_enabled: bool = True
    others: list[str] = field(default_factory=list)

    def node_name(self, name: str) -> str:
        """Return the name of a node after remapping."""
        return self._first("node_name", name) or name

    def namespace(self, node: str, namespace: str) -> str:
        """Return the namespace of a node after remapping.

        Args:
            node: name of the node before remapping.
            namespace: namespace before remapping.
        """
        return self._first("namespace", node) or namespace

    def _first(self, kind: str, node: str) -> str | None:
        return next((rule.new for rule in self.rules if rule.kind == kind and rule.node in ("", node)), None)

    def remap(self, full_name: str, node: str, namespace: str, *, is_service: bool = False) -> str:
        """Return the absolute name of a topic or service after remapping.

        Args:
            full_name: absolute name.
            node: name of the node.
            namespace: namespace of the node.
            is_service: True for a service.
        """
        kinds = ("any", "service" if is_service else "topic")
        for rule in self.rules:
            if rule.kind in kinds and rule.node in ("", node) and expand_name(rule.old, node, namespace) == full_name:
                return expand_name(rule.new, node, namespace)
        return full_name


_FLAGS: Final = {
    "--enable-rosout-logs": ("is_rosout_enabled", True),
    "--disable-rosout-logs": ("is_rosout_enabled", False),
    "--enable-stdout-logs": ("is_stdout_enabled", True),
    "--disable-stdout-logs": ("is_stdout_enabled", False),
    "--enable-external-lib-logs": ("", True),
    "--disable-external-lib-logs": ("", False),
}
_LEVELS: Final = ("debug", "info", "warn", "error", "fatal", "unset")
_VALUED: Final = {
    "-r": "--remap",
    "-p": "--param",
    "-e": "--enclave",
    "--remap": "--remap",
    "--param": "--param",
    "--params-file": "--params-file",
    "--log-level": "--log-level",
    "--log-config-file": "--log-config-file",
    "--log-file-name": "--log-file-name",
    "--enclave": "--enclave",
}


def parse_ros_arguments(arguments: Sequence[str]) -> RosArguments:
    """Read the arguments of a program.

    Args:
        arguments: words of the command line, such as `["node.py", "--ros-args", "-r", "a:=b"]`.

    Raises:
        RosArgumentsError: an argument after `--ros-args` is unknown or has no valid value.
    """
    parsed = RosArguments()
    is_inside = False
    unknown = []
    words = iter(arguments)
    for word in words:
        if word == "--ros-args":
            is_inside = True
        elif not is_inside:
            parsed.others.append(word)
        elif word == "--":
            is_inside = False
        elif word in _FLAGS:
            name, value = _FLAGS[word]
            if name:
                setattr(parsed, name, value)
        elif word in _VALUED:
            _add_argument(parsed, word, _VALUED[word], next(words, None))
        else:
            unknown.append(word)
    if unknown:
        raise UnknownArgumentsError(str(unknown))
    return parsed


def _add_argument(parsed: RosArguments, word: str, option: str, value: str | None) -> None:
    if value is None:
        raise RosArgumentsError(f"Couldn't parse trailing {word} flag. No {option.removeprefix('--')} rule found.")
    if option == "--remap":
        parsed.rules.append(parse_remap_rule(value))
    elif option == "--param":
        name, assigned, text = value.partition(":=")
        node, _, short = name.rpartition(":")
        if not assigned or not text or not _PARAMETER_NAME.fullmatch(short):
            raise RosArgumentsError(f"Couldn't parse parameter override rule: '{word} {value}'.")
        parsed.parameters.append((node, short, text))
    elif option == "--params-file":
        parsed.parameter_files.append(value)
    elif option == "--log-level":
        name, _, level = value.rpartition(":=")
        if level.lower() not in _LEVELS:
            text = f"Couldn't parse log level: '--log-level {value}'."
            raise RosArgumentsError(f"{text} Error: Argument does not use a valid severity level")
        parsed.levels[name] = level.lower()


def parse_remap_rule(text: str) -> RemapRule:
    """Read a rule such as `scan:=/robot/scan`, `__ns:=/robot` or `talker:__node:=speaker`.

    Raises:
        RosArgumentsError: the text is no rule.
    """
    error = RosArgumentsError(f"Couldn't parse remap rule: '-r {text}'.")
    left, assigned, new = text.partition(":=")
    if not assigned or not left or not new:
        raise error
    node, is_for_node, old = left.partition(":")
    if not is_for_node or old.startswith("//"):  # rostopic://name
        node, old = "", left
    if node and node_name_error(node):
        raise error
    if old in ("__node", "__name"):
        if node_name_error(new):
            raise error
        return RemapRule(node, "node_name", "", new)
    if old == "__ns":
        if namespace_error(new):
            raise error
        return RemapRule(node, "namespace", "", new)
    kind: Literal["any", "topic", "service"] = "any"
    if old.startswith("rostopic://"):
        kind, old = "topic", old.removeprefix("rostopic://")
    elif old.startswith("rosservice://"):
        kind, old = "service", old.removeprefix("rosservice://")
    # an old name such as /joint/0/cmd_pos, which ROS 1 and Gazebo have, is harmless: it gets a new one
    if topic_name_error(re.sub(r"(?<=/)(?=[0-9])", "_", old)) or topic_name_error(new):
        raise error
    return RemapRule(node, kind, old, new)
