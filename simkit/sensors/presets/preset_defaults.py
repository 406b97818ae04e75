"""Merging of a preset's numbers into a sensor as defaults: elements of the file take precedence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params
from simkit.scene import SceneSensor
from simkit.scene.overrides import SOURCE_PREFIX
from simkit.sensors.artefacts import artefact_elements
from simkit.sensors.presets import find, normalise_name, presets
from simkit.sensors.presets.preset import TIMING_ELEMENTS, Preset, Settings, format_value, outline

_OLD_BLOCKS = {"lidar": "ray", "navsat": "gps"}
"""Older spellings of blocks: a preset's block is merged into the block that the file has."""

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
"""Pairs of element sets that describe the same property of a block.

If the file has an element of one set, the preset's elements of the other set are dropped.
"""


def add_preset_defaults(sensor: SceneSensor, diagnostics: Diagnostics) -> SceneSensor:
    """Return the sensor with the numbers of its preset as defaults; the same sensor if it names no preset.

    An unknown or unsuitable preset is an error in `diagnostics`.
    """
    element = sensor.params.child("preset")
    if element is None:
        return sensor
    preset = _find_preset(sensor, element, diagnostics)
    if preset is None:
        return sensor
    added: dict[str, object] = {}
    elements, missing = _usable_elements(sensor, preset)
    params = _Merge(element.where, sensor.params.diagnostics).merged(sensor.params, elements, added)
    for child in ("preset", "update_rate"):
        params.child(child)
    text = outline(added) or "nothing, because the file sets everything itself"
    diagnostics.note(
        "SK-SENSOR-092", f"sensor {sensor.scoped!r}: preset {preset.name} gives {text}", element.where, preset.source
    )
    if missing:
        names = ", ".join(f"<{name}>" for name in missing)
        message = f"sensor {sensor.scoped!r}: preset {preset.name} also has {names}, which no installed pack provides"
        diagnostics.note("SK-SENSOR-265", message, element.where, "install simkit with its pack 'realism'")
    rate = preset.rate if "update_rate" in added else sensor.rate
    return replace(sensor, params=params, rate=rate)


def _usable_elements(sensor: SceneSensor, preset: Preset) -> tuple[Settings, list[str]]:
    """Return the elements of a preset that a sensor lacks, and the names of those that no installed pack provides.

    An element beside the block is added as a whole: an element of the file replaces it with all its children. A value
    of `--set` replaces one of them.
    """
    elements: dict[str, object] = {}
    missing: list[str] = []
    rate = sensor.rate if sensor.params.has("update_rate") else preset.rate
    for name, value in preset.elements.items():
        if name == "sweep" and not rate > 0:
            continue  # a scan at every step has no duration
        if name in preset.beside:
            own = next((child for child in sensor.params.children if child.name == name), None)
            if own is not None and not (own.where.file or "").startswith(SOURCE_PREFIX):
                continue
            if name not in TIMING_ELEMENTS and name not in artefact_elements():
                missing.append(name)
                continue
        elements[name] = value
    return elements, missing


def _find_preset(sensor: SceneSensor, element: Params, diagnostics: Diagnostics) -> Preset | None:
    presets_of_name = find(element.value)
    fitting = [p for p in presets() if sensor.kind in p.sensor_kinds]
    for preset in presets_of_name.values():
        if sensor.kind in preset.sensor_kinds:
            return preset
    names_of_kind = ", ".join(p.name for p in fitting)
    if presets_of_name:
        kinds = " and ".join(presets_of_name)
        message = f"sensor {sensor.scoped!r} of type {sensor.kind!r}: preset {element.value!r} is for {kinds}"
        hint = f"presets of this kind: {names_of_kind}" if names_of_kind else "there are none of this kind"
        diagnostics.error("SK-SENSOR-091", message, element.where, hint)
        return None
    names = {normalise_name(n): p.name for p in (fitting or presets()) for n in (p.name, *p.aliases)}
    suggestion = did_you_mean(normalise_name(element.value), names)
    for normalised, name in names.items():
        suggestion = suggestion.replace(repr(normalised), repr(name))
    all_presets = f"presets of this kind: {names_of_kind}" if names_of_kind else "there are none of this kind"
    message = f"sensor {sensor.scoped!r}: there is no preset {element.value!r}"
    diagnostics.error("SK-SENSOR-090", message, element.where, "; ".join(filter(None, (suggestion, all_presets))))
    return None


class _Merge:
    """Merge of a preset into a block; new elements get the place where the preset is named."""

    def __init__(self, where: Where, diagnostics: Diagnostics) -> None:
        self._where, self._diagnostics = where, diagnostics

    def merged(self, owner: Params, settings: Settings, added: dict[str, object]) -> Params:
        """Return a copy of `owner` with the settings that it lacks; record the added settings in `added`."""
        children = list(owner.children)
        attributes = dict(owner.attributes)
        for name, value in _missing_settings(owner, settings).items():
            if name.startswith("@"):
                if name[1:] not in attributes:
                    attributes[name[1:]] = added[name] = str(value)
                continue
            index = _find_child_index(children, name)
            if isinstance(value, list) and value and isinstance(value[0], (Mapping, list)):
                children += [self._repeated(name, item) for item in value]
                added[name] = value
            elif isinstance(value, Mapping):
                added_below: dict[str, object] = {}
                child = children[index] if index is not None else self._element(name)
                block = self.merged(child, value, added_below)
                if index is None:
                    children.append(block)
                else:
                    children[index] = block
                if added_below:
                    added[block.name] = added_below
            elif index is None:
                children.append(self._element(name, format_value(value)))
                added[name] = value
        return Params(owner.name, owner.value, attributes, children, owner.where, owner.diagnostics)

    def _repeated(self, name: str, item: Settings | list[object]) -> Params:
        """Return one of several elements with the same name."""
        if isinstance(item, list):
            return self._element(name, format_value(item))
        return self.merged(self._element(name), item, {})

    def _element(self, name: str, text: str = "") -> Params:
        return Params(name, text, where=self._where, diagnostics=self._diagnostics)


def _find_child_index(children: list[Params], name: str) -> int | None:
    """Return the index of the element with a name or with its older spelling; None if there is none."""
    for spelling in (name, _OLD_BLOCKS.get(name)):
        for index, child in enumerate(children):
            if child.name == spelling:
                return index
    return None


def _missing_settings(block: Params, settings: Settings) -> Settings:
    """Return the settings of a preset that a block lacks; none for a noise of type `none`."""
    present = {c.name for c in block.children} | {f"@{a}" for a in block.attributes}
    if block.name == "noise" and "none" in {block.attributes.get("type"), *(c.value for c in block.children)}:
        return {}
    dropped: set[str] = set()
    for first, second in _ALTERNATIVE_ELEMENTS.get(block.name, ()):
        dropped |= (second if present & first else set()) | (first if present & second else set())
    return {name: value for name, value in settings.items() if name not in dropped}
