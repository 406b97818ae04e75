"""Realism of a YAML file: presets and elements for the sensors and plugins that patterns select.

A file has these keys. The first pattern that matches a sensor or plugin is used.

    source: where the numbers come from
    sensors:
      "*::laser":              # scoped name, name, shell pattern of one of them, or kind
        preset: LDS-01
        elements:
          dropout: {probability: 0.25}
          noise: null          # removes the element
    plugins:
      "*diff_drive*":          # name, scoped name or file name
        elements:
          odometry_noise: {wheel_variance: 1.0e-5}
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import Diagnostics, Where, did_you_mean, name_hint
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.params import Params
from simkit.scene import SceneSensor
from simkit.scene.model import ScenePlugin
from simkit.sensors.artefacts import artefact_elements
from simkit.sensors.presets import find
from simkit.sensors.presets.preset import SENSOR_KINDS, TIMING_ELEMENTS, block_of
from simkit.sensors.realism.change import Change
from simkit.sensors.realism.datasheet import with_preset
from simkit.sensors.realism.element_changes import NewElements, is_override, with_elements
from simkit.yaml_reader import NotYaml, compose_nodes

if TYPE_CHECKING:
    import yaml

_KEYS: Final = ("sensors", "plugins", "source", "remark")
_ENTRY_KEYS: Final = {"sensors": ("preset", "elements", "source"), "plugins": ("elements", "source")}
_COMMON: Final = ("update_rate", "always_on")
_AXES: Final = ("xyz", "xy")
_MOST_VALUES: Final = 100_000
_DEEPEST: Final = 50
_INVALID: Final = "SK-SENSOR-270"
_UNKNOWN_ELEMENT: Final = "SK-SENSOR-272"


@dataclass(frozen=True, slots=True)
class Rule:
    """Elements for the sensors or plugins that a pattern selects.

    Attributes:
        pattern: name, shell pattern or kind.
        where: place of the pattern in the file.
        preset: element with the name of a preset; None for none.
        elements: elements that replace those of the world's file.
    """

    pattern: str
    where: Where
    preset: Params | None
    elements: tuple[NewElements, ...]


@dataclass(frozen=True, slots=True)
class RealismRules:
    """Content of a file.

    Attributes:
        name: name in messages.
        sensors, plugins: rules in the order of the file.
        is_set: True for a set that simkit or a pack has. Its patterns may match nothing, because it also serves robots
            without some of the sensors, and robots that are spawned later.
    """

    name: str
    sensors: tuple[Rule, ...]
    plugins: tuple[Rule, ...]
    is_set: bool


class FromFile(Change):
    """Changes that the rules of a file make."""

    def __init__(self, diagnostics: Diagnostics, rules: RealismRules) -> None:
        super().__init__(diagnostics)
        self._rules = rules
        self._used: dict[Where, list[str]] = {}
        self._names: list[str] = []

    def sensor(self, sensor: SceneSensor) -> SceneSensor:
        self._names += [sensor.scoped, sensor.name, sensor.kind]
        rule = _first_match(self._rules.sensors, (sensor.scoped, sensor.name, *_kinds_like(sensor.kind)))
        if rule is None:
            return sensor
        self._used.setdefault(rule.where, []).append(sensor.scoped)
        for element in rule.elements:
            self._check_element(element, sensor, rule)
        preset = rule.preset
        if preset is not None:
            own = next((child for child in sensor.params.children if child.name == "preset"), preset)
            preset = own if is_override(own) else preset
            devices = find(preset.value).values()
            device = next((p for p in devices if sensor.kind in p.sensor_kinds), None)
            if device is None:  # the preset's own check reports it with the place in this file
                return replace(sensor, params=_with_child(sensor.params, preset))
            sensor = with_preset(sensor, device, preset.where)
        params = with_elements(sensor.params, rule.elements)
        rate = next((e for e in rule.elements if e.name == "update_rate" and e.params), None)
        if rate is None:
            return replace(sensor, params=params)
        return replace(sensor, params=params, rate=params.number("update_rate", sensor.rate, minimum=0.0))

    def _check_element(self, element: NewElements, sensor: SceneSensor, rule: Rule) -> None:
        """Report an element that no sensor of the kind has; the sensor reports unknown elements inside of others."""
        block = block_of(_preset_kind(sensor.kind))
        allowed = {block, *_COMMON, *TIMING_ELEMENTS, *artefact_elements()}
        present = {child.name for child in sensor.params.children}
        if element.name not in allowed | present and element.params:
            message = f"sensor {sensor.scoped!r} of type {sensor.kind!r} has no element <{element.name}>"
            hint = did_you_mean(element.name, allowed) or f"elements: {', '.join(sorted(allowed))}"
            self.diagnostics.error(_UNKNOWN_ELEMENT, message, element.params[0].where, hint)

    def plugin(self, plugin: ScenePlugin) -> ScenePlugin:
        names = (plugin.name, f"{plugin.scoped}::{plugin.name}", plugin.filename)
        rule = _first_match(self._rules.plugins, names)
        if rule is None:
            return plugin
        self._used.setdefault(rule.where, []).append(f"{plugin.scoped}::{plugin.name}")
        return replace(plugin, params=with_elements(plugin.params, rule.elements, is_sensor=False))

    def report(self, *, is_world: bool) -> None:
        rules = (*self._rules.sensors, *self._rules.plugins)
        for rule in rules:
            if rule.where not in self._used and is_world and not self._rules.is_set:
                hint = name_hint(rule.pattern, dict.fromkeys(self._names))
                message = f"realism {self._rules.name}: the pattern {rule.pattern!r} matches no sensor or plugin"
                self.diagnostics.error("SK-SENSOR-271", message, rule.where, hint)
        if self._used:
            parts = (
                f"{rule.pattern} for {', '.join(self._used[rule.where])}" for rule in rules if rule.where in self._used
            )
            self.diagnostics.note("SK-SENSOR-269", f"realism {self._rules.name}: {'; '.join(parts)}", rules[0].where)
        elif is_world and self._rules.is_set:
            self.diagnostics.warning(
                "SK-SENSOR-273", f"realism {self._rules.name}: no sensor or plugin of the world is one of this set"
            )


def _first_match(rules: tuple[Rule, ...], names: tuple[str, ...]) -> Rule | None:
    return next((rule for rule in rules if any(fnmatchcase(name, rule.pattern) for name in names)), None)


def _preset_kind(kind: str) -> str:
    return next((name for name, kinds in SENSOR_KINDS.items() if kind in kinds), kind)


def _kinds_like(kind: str) -> tuple[str, ...]:
    return (kind, _preset_kind(kind))


def _with_child(params: Params, child: Params) -> Params:
    children = [*(c for c in params.children if c.name != child.name), child]
    return Params(params.name, params.value, params.attributes, children, params.where, params.diagnostics)


def _is_too_large(root: yaml.Node) -> bool:
    """Check the number and depth of the values; an alias counts at each of its places, and may contain itself."""
    stack, count = [(root, 0)], 0
    while stack:
        node, depth = stack.pop()
        count += 1
        if count > _MOST_VALUES or depth > _DEEPEST:
            return True
        if isinstance(node.value, list):
            for item in node.value:
                stack.extend((part, depth + 1) for part in (item if isinstance(item, tuple) else (item,)))
    return False


def read_realism_file(path: Path, diagnostics: Diagnostics, *, is_set: bool = False) -> RealismRules | None:
    """Read a file with all its problems; None if it cannot be read or has an error."""
    try:
        text = read_input(path, TEXT_LIMIT).decode("utf-8")
        root = compose_nodes(text)
    except OSError as error:
        diagnostics.error(_INVALID, f"cannot read {path}: {error.strerror}")
        return None
    except UnicodeDecodeError:
        diagnostics.error(_INVALID, f"{path} is not a text in UTF-8")
        return None
    except NotYaml as error:
        diagnostics.error(_INVALID, f"this is not YAML: {error}", Where(str(path), error.line))
        return None
    if root is not None and _is_too_large(root):
        message = f"{path} has more than {_MOST_VALUES} values, or is deeper than {_DEEPEST} levels, with its aliases"
        diagnostics.error(_INVALID, message)
        return None
    reader = _FileReader(str(path), diagnostics)
    errors = diagnostics.error_count
    rules = RealismRules(path.stem if is_set else path.name, *reader.rules(root), is_set)
    return rules if diagnostics.error_count == errors else None


class _FileReader:
    def __init__(self, file: str, diagnostics: Diagnostics) -> None:
        self._file, self._diagnostics = file, diagnostics

    def rules(self, root: yaml.Node | None) -> tuple[tuple[Rule, ...], tuple[Rule, ...]]:
        """Return the rules for sensors and for plugins."""
        found: dict[str, tuple[Rule, ...]] = {"sensors": (), "plugins": ()}
        if root is None:
            self._diagnostics.error(_INVALID, "the file is empty", Where(self._file, 1), _form())
            return (), ()
        for key, node in self._items(root, "the file", _KEYS).items():
            if key in found:
                entries = self._items(node, key)
                places = {str(name.value): self._where(name) for name, _ in node.value} if entries else {}
                found[key] = tuple(
                    self._rule(key, pattern, entry, places[pattern]) for pattern, entry in entries.items()
                )
        if not any(found.values()) and not self._diagnostics.has_errors:
            self._error(root, "the file has neither sensors nor plugins", _form())
        return found["sensors"], found["plugins"]

    def _rule(self, part: str, pattern: str, node: yaml.Node, where: Where) -> Rule:
        entry = self._items(node, repr(pattern), _ENTRY_KEYS[part])
        preset = entry.get("preset")
        named = None
        if preset is not None:
            named = Params("preset", self._text(preset), where=self._where(preset), diagnostics=self._diagnostics)
        elements = tuple(self._elements(entry["elements"], "elements")) if "elements" in entry else ()
        return Rule(pattern, where, named, elements)

    def _elements(self, node: yaml.Node, name: str) -> Iterator[NewElements]:
        for key, value in self._items(node, name).items():
            for axis in key if key in _AXES else (key,):
                yield NewElements(axis, tuple(self._params(axis, value)))

    def _params(self, name: str, node: yaml.Node) -> Iterator[Params]:
        """Yield the elements of a value: none for null, several for a list of mappings."""
        items = node.value if _kind(node) == "sequence" else []
        if items and all(_kind(item) in ("mapping", "sequence") for item in items):
            for item in items:
                yield from self._params(name, item)
            return
        where = self._where(node)
        if _kind(node) == "mapping":
            children: list[Params] = []
            attributes: dict[str, str] = {}
            for element in self._elements(node, name):
                if element.name.startswith("@"):
                    attributes[element.name[1:]] = "".join(param.value for param in element.params)
                children += () if element.name.startswith("@") else element.params
            yield Params(name, "", attributes, children, where, self._diagnostics)
        elif not node.tag.endswith(":null"):
            text = " ".join(map(self._text, items)) if items else self._text(node)
            yield Params(name, text, where=where, diagnostics=self._diagnostics)

    def _text(self, node: yaml.Node) -> str:
        if _kind(node) != "scalar":
            self._error(node, f"found {_kind(node)}, expected one value")
            return ""
        text = str(node.value)
        return text.lower() if node.tag.endswith(":bool") else text

    def _items(self, node: yaml.Node, name: str, allowed: tuple[str, ...] = ()) -> Mapping[str, yaml.Node]:
        """Return the values of a mapping by key; report another type, and keys that are unknown or repeated."""
        if _kind(node) != "mapping":
            self._error(node, f"{name}: found {_kind(node)}, expected a mapping", _form())
            return {}
        found: dict[str, yaml.Node] = {}
        for key, value in node.value:
            text = str(key.value) if _kind(key) == "scalar" else ""
            if not text or text in found or (allowed and text not in allowed):
                reason = "is repeated" if text in found else "is unknown"
                keys = f"; keys: {', '.join(allowed)}" if allowed else ""
                self._error(key, f"{name}: the key {text!r} {reason}", did_you_mean(text, allowed) + keys)
            else:
                found[text] = value
        return found

    def _where(self, node: yaml.Node) -> Where:
        return Where(self._file, node.start_mark.line + 1)

    def _error(self, node: yaml.Node, message: str, hint: str = "") -> None:
        self._diagnostics.error(_INVALID, message, self._where(node), hint.removeprefix("; "))


def _kind(node: yaml.Node) -> str:
    return str(getattr(node, "id", ""))  # "scalar", "sequence" or "mapping"


def _form() -> str:
    return "sensors: {PATTERN: {preset: NAME, elements: {…}}}"
