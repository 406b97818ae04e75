"""Arguments of a program as elements of a plugin: a known node whose work a plugin does hands them on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Final

import yaml

from simkit.plugins.ros_parameter_files import node_matches
from simkit_nodes.parameter_overrides import file_values, flat_values, rule_value

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

_ONE_LINE: Final = 10**9


def ros_element(program: NodeProgram, namespace: str, skipped: frozenset[str] = frozenset(), node: str = "") -> str:
    """Return the element `<ros>` of a plugin with the namespace, the remappings and the parameters of a program.

    Parameter files become parameters, because the texts of a model may not name any file.

    Args:
        program: program.
        namespace: namespace of the node; empty for none.
        skipped: names of parameters that the plugin does not take.
        node: plain name of the node that the parameters of the program are for; empty for each node of the plugin.
    """
    words: list[str] = []
    for rule in program.ros_arguments.rules:
        if rule.old:
            words += ["-r", f"{rule.node}:{rule.old}:={rule.new}" if rule.node else f"{rule.old}:={rule.new}"]
    for old, new in program.options.remap.items():
        words += ["-r", f"{old}:={new}"]
    for name, value in _parameters(program, namespace, f"{node}:" if node else ""):
        if name.rpartition(":")[2] not in skipped:
            words += ["-p", f"{name}:={_text(value)}"]
    arguments = "".join(f"<argument>{escape(word, quote=False)}</argument>" for word in words)
    return f"<ros><namespace>{escape(namespace, quote=False)}</namespace>{arguments}</ros>"


def _parameters(program: NodeProgram, namespace: str, prefix: str) -> Iterator[tuple[str, object]]:
    """Yield name and value of each parameter, with the name of its node before it; later ones replace earlier ones."""
    for path in program.ros_arguments.parameter_files:
        for pattern, name, value in file_values(Path(path)):
            plain = pattern.rpartition("/")[2]
            if "*" in plain:
                yield name, value
            elif node_matches(pattern, f"{namespace.rstrip('/')}/{plain}"):
                yield f"{plain}:{name}", value
    for of_node, name, text in program.ros_arguments.parameters:
        yield f"{of_node}:{name}" if of_node else f"{prefix}{name}", rule_value(name, text)
    for name, value in flat_values(program.options.params):
        yield f"{prefix}{name}", value


def _text(value: object) -> str:
    """Return a value as YAML in one line."""
    if isinstance(value, float) and math.isfinite(value):
        return repr(value)
    dumped: str = yaml.safe_dump(value, default_flow_style=True, width=_ONE_LINE, allow_unicode=True)
    return dumped.removesuffix("\n...\n").strip()
