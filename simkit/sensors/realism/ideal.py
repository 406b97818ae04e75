"""Realism `ideal`: sensors without noise, artefacts, sweep, shutter and latency, whatever the files ask for."""

from __future__ import annotations

from dataclasses import replace

from simkit.diagnostics import Diagnostics
from simkit.scene import SceneSensor
from simkit.scene.model import ScenePlugin
from simkit.sensors.presets.preset_defaults import add_preset_defaults
from simkit.sensors.realism.change import Change, listed
from simkit.sensors.realism.element_changes import without_children, without_errors, without_plugin_noise


class Ideal(Change):
    """Removal of all errors of sensors. Ranges, rates, lenses and layouts of points stay, also those of a preset."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        super().__init__(diagnostics)
        self._removed: dict[str, list[str]] = {}

    def sensor(self, sensor: SceneSensor) -> SceneSensor:
        found = Diagnostics()
        complete = add_preset_defaults(sensor, found)
        if found.has_errors:
            return sensor  # its error is reported where the sensor is made
        removed: set[str] = set()
        params = without_children(without_errors(complete.params, removed), ("preset",), set())
        self._note(removed, sensor.scoped)
        return sensor if params is sensor.params else replace(complete, params=params)

    def plugin(self, plugin: ScenePlugin) -> ScenePlugin:
        removed: set[str] = set()
        params = without_plugin_noise(plugin.params, removed)
        self._note(removed, f"{plugin.scoped}::{plugin.name}")
        return plugin if params is plugin.params else replace(plugin, params=params)

    def _note(self, removed: set[str], name: str) -> None:
        for element in sorted(removed):
            self._removed.setdefault(element, []).append(name)

    def report(self, *, is_world: bool) -> None:
        if self._removed:
            parts = (f"<{element}> of {listed(names)}" for element, names in sorted(self._removed.items()))
            self.diagnostics.note("SK-SENSOR-266", f"realism ideal: removed {'; '.join(parts)}")
