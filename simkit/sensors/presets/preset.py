"""A preset: the published numbers of a device, as elements of an SDF file, loaded from the TOML files in `data/`.

There is one file for each maker or family. Keys above the first `[[preset]]` of a file hold for all presets of that
file. Settings are in SI units; `xyz` and `xy` stand for axes with the same settings. A comment gives the number of the
data sheet where its unit differs.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

Settings = Mapping[str, Any]
"""Elements of a `<sensor>` by name: a mapping is an element with children, `@name` in it an attribute."""

SENSOR_KINDS: Mapping[str, tuple[str, ...]] = {
    "lidar": ("lidar", "ray", "gpu_lidar", "gpu_ray"),
    "navsat": ("navsat", "gps"),
    "depth_camera": ("depth_camera", "depth"),
}
"""Sensor types that share a block; a kind that is not here is the one type of its name."""

_FOLDER: Final = Path(__file__).parent / "data"
_AXES: Final = ("xyz", "xy")
_BLOCKS = {"depth_camera": "camera", "rgbd_camera": "camera"}


@dataclass(frozen=True, slots=True)
class Preset:
    """A device, and what its data sheet says of it.

    Attributes:
        name: as the maker writes it. Several presets may have one name where a device is several sensors.
        kind: of sensor; `lidar` stands for `ray`, `gpu_lidar` and `gpu_ray` too.
        maker: who sells it.
        source: data sheet, with its revision where that is certain, and where in it the numbers are.
        settings: elements of the sensor, in SI units.
        rate: samples a second [Hz]; 0 where the data sheet leaves it to the user.
        aliases: other names of the same device.
        remark: what the numbers leave out, or how one was made of a published one.
        unconfirmed: elements whose numbers were found in no second place, with the names above where one is not enough.
    """

    name: str
    kind: str
    maker: str
    source: str
    settings: Settings
    rate: float = 0.0
    aliases: tuple[str, ...] = ()
    remark: str = ""
    unconfirmed: tuple[str, ...] = ()

    @property
    def sensor_kinds(self) -> tuple[str, ...]:
        """The `<sensor type>`s that may name it."""
        return SENSOR_KINDS.get(self.kind, (self.kind,))

    @property
    def block(self) -> str:
        """The element that the settings are in."""
        return _BLOCKS.get(self.kind, self.kind)

    @property
    def elements(self) -> Settings:
        """All of it: the settings, and the rate where there is one."""
        return {"update_rate": self.rate, **self.settings} if self.rate else self.settings


def load_presets() -> Iterator[Preset]:
    """Read every preset, file by file.

    Raises:
        TypeError: a preset has an unknown key or lacks one.
    """
    for file in sorted(_FOLDER.glob("*.toml")):
        table = tomllib.loads(file.read_text(encoding="utf-8"))
        entries = table.pop("preset")
        for entry in entries:
            yield _make_preset({**table, **entry})


def _make_preset(fields: Settings) -> Preset:
    lists = {name: tuple(value) for name, value in fields.items() if isinstance(value, list)}
    return Preset(**{**fields, **lists, "settings": _expand_axes(fields["settings"])})


def _expand_axes(settings: Settings) -> Settings:
    """Give each axis of `xyz` and `xy` the settings that they have in common."""
    expanded: dict[str, object] = {}
    for key, value in settings.items():
        value = _expand_axes(value) if isinstance(value, dict) else value
        for name in key if key in _AXES else (key,):
            expanded[name] = value
    return expanded


def outline(settings: Settings) -> str:
    """The settings on one line; neighbours that say the same (the axes of an IMU, mostly) are said once."""
    return ", ".join(_outline_items(settings))


def _outline_items(settings: Settings) -> list[str]:
    names: dict[str, list[str]] = {}
    said = {name: value for name, value in settings.items() if not str(value).startswith("gaussian")} or settings
    for name, value in said.items():
        if isinstance(value, Mapping):
            within = _outline_items(value)
            names.setdefault(f" ({', '.join(within)})" if len(within) > 1 else f" {within[0]}", []).append(name)
        else:
            names[f"{name} {format_value(value)}".removeprefix("@")] = []
    return ["/".join(of_these) + text for text, of_these in names.items()]


def format_value(value: object) -> str:
    """A value as a file would have it: a number with all its digits, `true` or `false`."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}" if float(f"{value:.6g}") == value else repr(value)
    return str(value)
