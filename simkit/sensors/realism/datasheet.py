"""Realism `datasheet`: sensors that are known devices get the noise, losses, sweep and timing of their data sheets."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

from simkit.diagnostics import Diagnostics, Where
from simkit.number_text import number_or_nan
from simkit.packs import pack_folders
from simkit.params import Params
from simkit.scene import SceneSensor
from simkit.scene.model import ScenePlugin
from simkit.scene.param_paths import parameter_values
from simkit.sensors.presets import Preset, find
from simkit.sensors.realism.change import Change, listed
from simkit.sensors.realism.element_changes import NOISE_ELEMENTS, without_children, without_noise

_TABLE: Final = "known_devices.toml"
_LIDAR_SPELLINGS: Final = ("ray", "gpu_lidar", "gpu_ray")


@dataclass(frozen=True)
class KnownDevice:
    """Device with the properties by which a sensor of it is recognised.

    Attributes:
        preset: name of its preset.
        kind: kind of the preset.
        names: shell patterns of scoped names in lower case; one of them matches.
        values: values of elements by path, or a lower and an upper limit; all of them hold.
    """

    preset: str
    kind: str
    names: Sequence[str]
    values: Mapping[str, float | Sequence[float]] = field(default_factory=dict)

    def reason(self, sensor: SceneSensor) -> str:
        """Return the reason why a sensor is this device, or an empty text."""
        device = find(self.preset).get(self.kind)
        if device is None or sensor.kind not in device.sensor_kinds:
            return ""
        name = sensor.scoped.lower()
        pattern = next((pattern for pattern in self.names if fnmatchcase(name, pattern)), "")
        if not pattern or not self._has_values(sensor.params):
            return ""
        values = "".join(f", {path} as for the device" for path in self.values)
        return f"name like {pattern!r}{values}"

    def _has_values(self, params: Params) -> bool:
        if not self.values:
            return True
        found = dict(parameter_values(params))
        for path, value in self.values.items():
            first, dot, rest = path.partition(".")
            spellings = (first, *(_LIDAR_SPELLINGS if first == "lidar" else ()))
            text = next((found[f"{s}{dot}{rest}"] for s in spellings if f"{s}{dot}{rest}" in found), "")
            low, high = (value, value) if isinstance(value, (int, float)) else value
            if not low <= number_or_nan(text) <= high:
                return False
        return True


@functools.cache
def known_devices() -> tuple[KnownDevice, ...]:
    """Return the devices of the core and of all packs, in the order in which they are tried."""
    folders = (Path(__file__).parent, *map(Path, pack_folders("sensors/realism")))
    files = (folder / _TABLE for folder in folders)
    return tuple(
        KnownDevice(**entry)
        for file in files
        if file.is_file()
        for entry in tomllib.loads(file.read_text(encoding="utf-8"))["device"]
    )


def with_preset(sensor: SceneSensor, device: Preset, where: Where) -> SceneSensor:
    """Return a sensor that names a preset, and whose noise is that of the preset if the preset has noise.

    Losses, sweep and timing of the preset replace those of the file; `add_preset_defaults` adds them later.
    """
    params = without_children(sensor.params, device.beside, set())
    if _has_noise(device.settings):
        params = without_noise(params, set())
    named = Params("preset", device.name, where=where, diagnostics=params.diagnostics)
    children = [*(child for child in params.children if child.name != "preset"), named]
    return replace(
        sensor,
        params=Params(params.name, params.value, params.attributes, children, params.where, params.diagnostics),
    )


def _has_noise(settings: Mapping[str, object]) -> bool:
    return any(
        name in NOISE_ELEMENTS or (isinstance(value, Mapping) and _has_noise(value)) for name, value in settings.items()
    )


class Datasheet(Change):
    """Presets for the sensors that name one or that are known devices; all other sensors stay as they are."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        super().__init__(diagnostics)
        self._unchanged: list[str] = []

    def sensor(self, sensor: SceneSensor) -> SceneSensor:
        named = next((child for child in sensor.params.children if child.name == "preset"), None)
        if named is not None:
            device = next((p for p in find(named.value).values() if sensor.kind in p.sensor_kinds), None)
            return sensor if device is None else with_preset(sensor, device, named.where)
        for known in known_devices():
            reason = known.reason(sensor)
            if reason:
                message = f"realism datasheet: sensor {sensor.scoped!r} is taken for {known.preset} ({reason})"
                self.diagnostics.note("SK-SENSOR-267", message, sensor.where, "to choose another: <simkit:preset>")
                return with_preset(sensor, find(known.preset)[known.kind], sensor.where)
        self._unchanged.append(sensor.scoped)
        return sensor

    def plugin(self, plugin: ScenePlugin) -> ScenePlugin:
        return plugin

    def report(self, *, is_world: bool) -> None:
        if self._unchanged:
            message = f"realism datasheet: no known device, so unchanged: {listed(self._unchanged)}"
            self.diagnostics.note("SK-SENSOR-268", message, hint="name one with <simkit:preset>, or use a YAML file")
