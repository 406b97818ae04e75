"""Values that are valid in one part of a launch file of ROS 1, and the words that a node gets on its command line."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from simkit.extend import Where
from simkit_launch.frontends.roslaunch_substitutions import AnonymousNames
from simkit_launch.frontends.roslaunch_values import canonical_name, convert_text, join_names

_ROS_WORD: Final = re.compile(r"(?P<old>(?:[~/A-Za-z]|__?)[\w/]*):=(?P<new>.*)", re.DOTALL)


@dataclass
class RoslaunchScope:
    """Values that are valid in one element: a file, a group, or an include.

    Attributes:
        file: launch file.
        namespace: absolute namespace without a slash at its end; empty for the global one.
        arguments: values of arguments.
        declared: arguments that the file has declared so far, with the place of each.
        failed: arguments without a value because of an error that is recorded.
        passes_all: True if the includer passes all its arguments, so that the file may set them again.
        remappings: new names by old names.
        private: private parameters that each later node gets.
        environment: variables of the environment.
        anonymous: names of `$(anon …)`.
    """

    file: Path
    namespace: str = ""
    arguments: dict[str, str] = field(default_factory=dict)
    declared: dict[str, Where] = field(default_factory=dict)
    failed: set[str] = field(default_factory=set)
    passes_all: bool = False
    remappings: dict[str, str] = field(default_factory=dict)
    private: dict[str, Any] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    anonymous: AnonymousNames = field(default_factory=AnonymousNames)

    def child(self, namespace: str = "") -> RoslaunchScope:
        """Return a scope inside this one; its changes do not reach this one."""
        return replace(
            self,
            namespace=canonical_name(join_names(self.namespace + "/", namespace)) if namespace else self.namespace,
            arguments=dict(self.arguments),
            declared=dict(self.declared),
            failed=set(self.failed),
            remappings=dict(self.remappings),
            private=dict(self.private),
            environment=dict(self.environment),
            anonymous=self.anonymous.copy(),
        )


def split_ros_words(words: Iterable[str]) -> tuple[str, str, list[tuple[str, str]], dict[str, Any], list[str]]:
    """Split `old:=new`, `_parameter:=value`, `__name:=NAME` and `__ns:=NAMESPACE` from the words of a program.

    Returns:
        Name and namespace, empty if not given; remappings; private parameters; and the other words.
    """
    name = namespace = ""
    remappings: list[tuple[str, str]] = []
    private: dict[str, Any] = {}
    plain: list[str] = []
    for word in words:
        match = _ROS_WORD.fullmatch(word)
        if match is None:
            plain.append(word)
        elif match["old"] == "__name":
            name = match["new"]
        elif match["old"] == "__ns":
            namespace = canonical_name(join_names("/", match["new"]))
        elif match["old"].startswith("_") and not match["old"].startswith("__"):
            private[match["old"][1:]] = convert_text(match["new"], "yaml")
        elif not match["old"].startswith("__"):
            remappings.append((match["old"], match["new"]))
    return name, namespace, remappings, private, plain
