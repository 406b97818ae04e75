"""Values of a launch file in parameter files: `$(var NAME)` of ROS 2 and `$(arg NAME)` of ROS 1.

simkit runs no launch file. A launch file usually passes the same values to the robot's xacro file, so a name stands for
the value of the xacro argument with this name, as given with `--xacro-arg` or by the default in the file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from simkit.extend import Diagnostics, Where, did_you_mean
from simkit.plugins.ros_parameter_files import Entry, ParameterFile, parse_parameter

_SUBSTITUTION: Final = re.compile(r"\$\((?:var|arg)\s+([^\s()]+)\s*\)")


def substitute_arguments(file: ParameterFile, arguments: Mapping[str, str], diagnostics: Diagnostics) -> ParameterFile:
    """Return a parameter file in which names and values contain the values of the robot's xacro arguments.

    A name without a value becomes an empty text, with a warning; `$(var prefix)` is usually empty for a single robot.
    """
    substitution = _Substitution(arguments, diagnostics)
    nodes = [(substitution.text(pattern, entry.where), substitution.entry(entry)) for pattern, entry in file.nodes]
    root = None if file.root is None else substitution.entry(file.root)
    return replace(file, nodes=nodes, root=root) if substitution.is_used else file


@dataclass
class _Substitution:
    """Substitution of one file; each name without a value is reported once."""

    arguments: Mapping[str, str]
    diagnostics: Diagnostics
    is_used: bool = False
    missing: set[str] = field(default_factory=set)

    def entry(self, entry: Entry) -> Entry:
        """Return an entry with all names and values substituted."""
        if entry.below is not None:
            below = {self.text(key, inner.where): self.entry(inner) for key, inner in entry.below.items()}
            return replace(entry, below=below)
        if entry.items is not None:
            return replace(entry, items=[self.entry(item) for item in entry.items])
        if "$(" not in entry.text:
            return entry
        text = self.text(entry.text, entry.where)
        if _SUBSTITUTION.fullmatch(entry.text):  # the value may be a number, a flag or a list
            parsed = parse_parameter("value", text, entry.where, self.diagnostics)
            return (parsed.below or {}).get("value", entry) if parsed is not None else entry
        return replace(entry, text=text)

    def text(self, text: str, where: Where) -> str:
        """Return a text with the values of the arguments."""
        return _SUBSTITUTION.sub(lambda match: self._value(match.group(1), where), text) if "$(" in text else text

    def _value(self, name: str, where: Where) -> str:
        self.is_used = True
        if name not in self.arguments and name not in self.missing:
            self.missing.add(name)
            message = f"$(var {name}) has no value, because the robot has no xacro argument {name!r}; it is empty"
            hint = did_you_mean(name, self.arguments) or f"set it with --xacro-arg {name}:=VALUE"
            self.diagnostics.warning("SK-CONTROL-003", message, where, hint)
        return self.arguments.get(name, "")
