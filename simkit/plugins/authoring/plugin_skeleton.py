"""Writes a plugin with typed parameters."""

from __future__ import annotations

import keyword
import re
from collections.abc import Sequence
from pathlib import Path

from simkit.plugins.authoring.element_types import Element
from simkit.plugins.authoring.new_plugins import NewPlugin

_BASES = {"world": "WorldPlugin", "model": "ModelPlugin", "visual": "VisualPlugin", "sensor": "SensorPlugin"}
_PARENTS = {"world": "Simulation", "model": "Model", "visual": "Visual", "sensor": "Sensor"}
_TYPES = {"number": "float", "boolean": "bool", "text": "str", "pose": "Pose", "block": "dict[str, Any]"}
_RATES = {"update_rate", "updateRate", "updateRateHZ", "update_frequency", "rate"}
_WIDEST = 118
DEEPEST = 3  # blocks within blocks that are read at once
_NAMES_OF_PLUGIN = """
sim name scoped params where ros log source period parent_kind filenames names before_step after_step reset load
prepare close advertise listen offer act declare random get_state set_state before_step_rate after_step_rate
lets_sleep drives reads_parameter_files has_hook
"""
_OWN = frozenset(_NAMES_OF_PLUGIN.split())
"""Names that a plugin has already."""


def plugin_text(wanted: NewPlugin) -> str:
    """The plugin's module."""
    base, lines = _BASES[wanted.parent], _read_statements(wanted.elements, "params", "        ")
    names = attribute_names(wanted.elements)
    rate = next((names[e.name] for e in wanted.elements if e.name in _RATES and _is_one_number(e)), None)
    uses = _uses(wanted)
    imports = sorted({base, "Params", *(["Pose"] if any("Pose.from_rpy(" in line for line in lines) else [])})
    header = [
        f'"""In place of `{_printable(wanted.filename or wanted.class_name)}`.{uses}\n"""' if uses else
        f'"""The plugin `{wanted.class_name}`: a world names it `{_printable(wanted.filename)}`."""',
        "",
        "from __future__ import annotations",
        "",
        "from typing import Any",
        "",
        f"from simkit import {', '.join(imports)}",
        "",
        "",
        f"class {wanted.class_name}({base}):",
        f'    """What it does for the {wanted.parent} it hangs on."""',
        "",
    ]  # fmt: skip
    if not _CALLED_BY_FILE.search(wanted.filename):
        header.append(f"    filenames = ({quote_text(wanted.filename)},)")
    if wanted.gz_names:
        header.append(f"    names = ({', '.join(map(quote_text, wanted.gz_names))},)")
    header += [
        "    after_step_rate = 10.0  # Hz of simulated time; None is every step",
        "",
        "    def load(self, parent: Any, params: Params) -> None:",
        f'        """Once, at t = 0, when everything is built; `parent` is the `{_PARENTS[wanted.parent]}`."""',
        "        self.parent = parent",
        *lines,
        *([f"        self.after_step_rate = max(0.0, self.{rate})"] if rate else []),
        "",
        "    def after_step(self) -> None:",
        '        """After a physics step, at `after_step_rate`: readings."""',
        "",
    ]
    return "\n".join(header)


def _uses(wanted: NewPlugin) -> str:
    """Where it is named, without the folders of somebody's machine."""
    places: dict[str, list[str]] = {}
    for plugin in wanted.plugins:
        if plugin.where.file and plugin.where.line:
            places.setdefault(Path(plugin.where.file).name, []).append(str(plugin.where.line))
    told = [f"Named in {file}, line {', '.join(lines[:8])}." for file, lines in places.items()]
    return "".join(f"\n\n{line}" for line in told[:5])


_CALLED_BY_FILE = re.compile(r"\.py$|^[\w.]+:\w+$|^$")


def _read_statements(elements: Sequence[Element], owner: str, indent: str) -> list[str]:
    """One statement for each parameter."""
    names = attribute_names(elements)
    lines: list[str] = []
    for element in elements:
        if element.depth > DEEPEST and not element.repeated:
            lines.append(f"{indent}self.{names[element.name]}: Params = {owner}.block({quote_text(element.name)})")
            lines.append(f"{indent}self.{names[element.name]}.mark_all_read()  # to be read as it is needed")
            continue
        kind = _type(element)
        value = _read(element, owner)
        lines += break_expression(f"{indent}self.{names[element.name]}: {kind} = ", value, indent)
    return lines


def break_expression(head: str, expression: str, indent: str, tail: str = "") -> list[str]:
    """An expression in lines that are not too long: what is in its outermost brackets, each on a line of its own."""
    line = f"{head}{expression}{tail}"
    parts = _within_brackets(expression) if len(line) > _WIDEST else None
    if parts is None:
        return [line]
    opening, inside, closing = parts
    lines = [head + opening]
    for part in inside:
        comma = "" if part.startswith("for ") or (len(inside) > 1 and inside[-1].startswith("for ")) else ","
        key = re.match(r'"[^"]*": ', part)
        begin = key[0] if key else ""
        lines += break_expression(f"{indent}    {begin}", part.removeprefix(begin), indent + "    ", comma)
    return [*lines, f"{indent}{closing}{tail}"]


def _within_brackets(expression: str) -> tuple[str, list[str], str] | None:
    """An expression as what comes up to its first bracket, the parts within, and what closes it."""
    first = re.search(r"[\[({]", expression)
    if first is None or expression[-1] not in "])}":
        return None
    parts, depth, begin, quote = [], 0, first.end(), ""
    for i in range(first.end(), len(expression) - 1):
        letter = expression[i]
        if quote:
            quote = "" if letter == quote and expression[i - 1] != chr(92) else quote
        elif letter in "\"'":
            quote = letter
        elif letter in "[({":
            depth += 1
        elif letter in "])}":
            depth -= 1
        elif depth == 0 and (letter == "," or expression.startswith(" for ", i)):
            parts.append(expression[begin:i].strip())
            begin = i + 1
        if depth < 0:
            return None  # it is not one bracket: f(x)[0]
    parts.append(expression[begin:-1].strip())
    return expression[: first.end()], [part for part in parts if part], expression[-1]


def _type(element: Element) -> str:
    kind = _TYPES.get(element.kind, "tuple[float, ...]")
    return f"list[{kind}]" if element.repeated else kind


def _read(element: Element, owner: str) -> str:
    """The expression that reads an element of the block called `owner`."""
    name = quote_text(element.name)
    if element.kind == "block":
        if element.repeated:
            return f"[{_as_dict(element, 'one')} for one in {owner}.all({name})]"
        return _as_dict(element, f"{owner}.block({name})")
    if element.repeated:
        return f"[{_read_one(element, 'one')} for one in {owner}.each({name})]"
    return _read_one(element, owner)


def _as_dict(element: Element, block: str) -> str:
    entries = []
    for child in element.children:
        if child.name.startswith("@"):
            read = f"{block}.attribute({quote_text(child.name[1:])}, {quote_text(child.values[0])})"
        else:
            read = _read(child, block)
        entries.append(f"{quote_text(child.name)}: {read}")
    if element.values:
        entries.append(f'"": {block}.value')
    return "{" + ", ".join(entries) + "}"


def _read_one(element: Element, owner: str) -> str:
    """The expression that reads one element, with the value first found as its default."""
    name, value = quote_text(element.name), element.values[0]
    if element.kind == "boolean":
        return f"{owner}.boolean({name}, {value.lower() in ('true', '1')})"
    if element.kind == "number":
        endless = ", finite=False" if "inf" in value.lower() else ""
        return f"{owner}.number({name}, {number_text(value)}{endless})"
    if element.kind == "pose":
        return f"{owner}.pose({name}, Pose.from_rpy({', '.join(map(number_text, value.split()))}))"
    if element.kind == "vector":
        return f"{owner}.vector({name}, {element.size}, ({', '.join(map(number_text, value.split()))}))"
    return f"{owner}.text({name}, {quote_text(value)})"


def number_text(text: str) -> str:
    """A number of a file as Python writes it."""
    number = float(text)
    return f'float("{number}")' if number in (float("inf"), float("-inf")) else repr(number)


def _is_one_number(element: Element) -> bool:
    return element.kind == "number" and not element.repeated


def attribute_names(elements: Sequence[Element]) -> dict[str, str]:
    """The attribute for each element: in Python's spelling, and none that a plugin has already."""
    found: dict[str, str] = {}
    for element in elements:
        name = re.sub(r"\W+", "_", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", element.name)).lower().strip("_") or "value"
        if name[0].isdigit():
            name = f"value_{name}"
        if name in _OWN or name == "parent" or keyword.iskeyword(name):
            name += "_value"
        while name in found.values():
            name += "_2"
        found[element.name] = name
    return found


def quote_text(text: str) -> str:
    """A text as Python writes it, with double quotes where that is as well."""
    shown = repr(text)
    return f'"{text}"' if shown == f"'{text}'" and '"' not in text else shown


def _printable(text: str) -> str:
    return text.replace("\\", "/").replace('"', "'")
