"""Parameters that a sensor reads, with the defaults of those that its file does not give."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.scene import SceneSensor
from simkit.sensors import sensor_kinds
from simkit.sensors.presets.preset_defaults import add_preset_defaults


class RecordedParams(Params):
    """Block of parameters that records the defaults of the values that its reader did not find.

    Attributes:
        defaults: default, or block with defaults, of each absent element by name.
    """

    __slots__ = ("defaults",)

    def __init__(self, source: Params) -> None:
        children = [RecordedParams(child) for child in source.children]
        super().__init__(source.name, source.value, source.attributes, children, source.where, Diagnostics())
        self.defaults: dict[str, object] = {}

    def block(self, name: str) -> Params:
        child = self.child(name)
        if child is None:
            child = self.defaults[name] = RecordedParams(Params(name, where=self.where))
        return child

    def number(self, name: str, default: float | None = None, *args: Any, **options: Any) -> float:
        if default is not None and math.isfinite(default):
            self.defaults.setdefault(name, default)
        return super().number(name, default, *args, **options)

    def _value(self, name: str, default: Any, *args: Any) -> Any:
        if default is not None:
            self.defaults.setdefault(name, default)
        return super()._value(name, default, *args)


def read_parameters(sensor: SceneSensor) -> Params:
    """Return the parameters of a sensor with those of its preset, and with the defaults of all that it reads."""
    complete = add_preset_defaults(sensor, Diagnostics())
    kind = sensor_kinds().get(complete.kind)
    recorded = RecordedParams(complete.params)
    if kind is not None:
        kind(replace(complete, params=recorded), Diagnostics()).describe()
    return recorded
