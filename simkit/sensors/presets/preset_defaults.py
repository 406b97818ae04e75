"""Add a preset's numbers as defaults to a sensor of a file: the file wins, element by element."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params
from simkit.scene import SceneSensor
from simkit.sensors.presets import find, normalise_name, presets
from simkit.sensors.presets.preset import Preset, Settings, format_value, outline

_OLD_BLOCKS = {"lidar": "ray", "navsat": "gps"}
"""Blocks with an older spelling: a preset's goes into the one that the file has."""

_ALTERNATIVE_ELEMENTS = {
    "noise": (
        ({"stddev"}, {"noise_density"}),
        (
            {"dynamic_bias_stddev", "dynamic_bias_correlation_time"},
            {"random_walk", "bias_instability", "correlation_time"},
        ),
        ({"type"}, {"@type"}),
    ),
    "encoder": (({"resolution"}, {"counts_per_revolution"}),),
}
"""Two ways to say one thing of a block: who says it in one takes nothing from a preset that says it in the other."""


def add_preset_defaults(sensor: SceneSensor, diagnostics: Diagnostics) -> SceneSensor:
    """The sensor with the numbers of the device it names under its own; the same sensor where it names none.

    What is wrong with the name is an error in `diagnostics`.
    """
    element = sensor.params.child("preset")
    if element is None:
        return sensor
    preset = _find_preset(sensor, element, diagnostics)
    if preset is None:
        return sensor
    given: dict[str, object] = {}
    params = _Merge(element.where, sensor.params.diagnostics).merged(sensor.params, preset.elements, given)
    for child in ("preset", "update_rate"):
        params.child(child)
    what = outline(given) or "nothing that the file does not say itself"
    diagnostics.note(
        "SK-SENSOR-092", f"sensor {sensor.scoped!r}: preset {preset.name} gives {what}", element.where, preset.source
    )
    rate = preset.rate if "update_rate" in given else sensor.rate
    return replace(sensor, params=params, rate=rate)


def _find_preset(sensor: SceneSensor, element: Params, diagnostics: Diagnostics) -> Preset | None:
    found = find(element.value)
    fitting = [p for p in presets() if sensor.kind in p.sensor_kinds]
    for preset in found.values():
        if sensor.kind in preset.sensor_kinds:
            return preset
    mine = ", ".join(p.name for p in fitting)
    if found:
        kinds = " and ".join(found)
        message = (
            f"sensor {sensor.scoped!r}: preset {element.value!r} is of kind {kinds}, the sensor is {sensor.kind!r}"
        )
        hint = f"presets of this kind: {mine}" if mine else "there are none of this kind"
        diagnostics.error("SK-SENSOR-091", message, element.where, hint)
        return None
    names = {normalise_name(n): p.name for p in (fitting or presets()) for n in (p.name, *p.aliases)}
    near = did_you_mean(normalise_name(element.value), names)
    for plain, name in names.items():
        near = near.replace(repr(plain), repr(name))
    all_of_it = f"presets of this kind: {mine}" if mine else "there are none of this kind"
    message = f"sensor {sensor.scoped!r}: there is no preset {element.value!r}"
    diagnostics.error("SK-SENSOR-090", message, element.where, "; ".join(filter(None, (near, all_of_it))))
    return None


class _Merge:
    """Makes elements that stand where the preset is named."""

    def __init__(self, where: Where, diagnostics: Diagnostics) -> None:
        self._where, self._diagnostics = where, diagnostics

    def merged(self, owner: Params, settings: Settings, given: dict[str, object]) -> Params:
        """A copy of `owner` with what it does not say itself; what was taken goes into `given`."""
        children = list(owner.children)
        attributes = dict(owner.attributes)
        for name, value in _missing_settings(owner, settings).items():
            if name.startswith("@"):
                if name[1:] not in attributes:
                    attributes[name[1:]] = given[name] = str(value)
                continue
            at = _find_child_index(children, name)
            if isinstance(value, Mapping):
                below: dict[str, object] = {}
                mine = children[at] if at is not None else self._element(name)
                block = self.merged(mine, value, below)
                if at is None:
                    children.append(block)
                else:
                    children[at] = block
                if below:
                    given[block.name] = below
            elif at is None:
                children.append(self._element(name, format_value(value)))
                given[name] = value
        return Params(owner.name, owner.value, attributes, children, owner.where, owner.diagnostics)

    def _element(self, name: str, text: str = "") -> Params:
        return Params(name, text, where=self._where, diagnostics=self._diagnostics)


def _find_child_index(children: list[Params], name: str) -> int | None:
    """Where the element is that a reader would take; an older spelling of it counts."""
    for spelling in (name, _OLD_BLOCKS.get(name)):
        for at, child in enumerate(children):
            if child.name == spelling:
                return at
    return None


def _missing_settings(block: Params, settings: Settings) -> Settings:
    """What a block of the file may take from a preset: nothing if it is a noise that is to be none."""
    said = {c.name for c in block.children} | {f"@{a}" for a in block.attributes}
    if block.name == "noise" and "none" in {block.attributes.get("type"), *(c.value for c in block.children)}:
        return {}
    dropped: set[str] = set()
    for one, other in _ALTERNATIVE_ELEMENTS.get(block.name, ()):
        dropped |= (other if said & one else set()) | (one if said & other else set())
    return {name: value for name, value in settings.items() if name not in dropped}
