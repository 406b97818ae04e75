"""Presets: the published numbers of a device as elements of an SDF file, loaded from the TOML files in `data/`.

There is one file for each maker or family. Keys above the first `[[preset]]` of a file apply to all presets of that
file. Settings are in SI units. `xyz` and `xy` abbreviate axes with the same settings. If the data sheet uses another
unit, a comment gives its number.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from simkit.number_text import counted
from simkit.packs import pack_folders

Settings = Mapping[str, Any]
"""Elements of a `<sensor>` by name: a mapping is an element with children, a key `@name` is an attribute."""

SENSOR_KINDS: Mapping[str, tuple[str, ...]] = {
    "lidar": ("lidar", "ray", "gpu_lidar", "gpu_ray"),
    "navsat": ("navsat", "gps"),
    "depth_camera": ("depth_camera", "depth"),
}
"""Sensor types that share a block, by kind; a kind that is not listed has one type of the same name."""

TIMING_ELEMENTS: Final = ("jitter", "latency", "latency_jitter", "phase", "shutter", "sweep")
"""Elements of the core that a `<sensor>` may have beside its block, except its rate."""

_FOLDER: Final = Path(__file__).parent / "data"
_AXES: Final = ("xyz", "xy")
_BLOCKS = {"depth_camera": "camera", "rgbd_camera": "camera"}
_LONGEST_LIST: Final = 6  # numbers of a list that a description shows


@dataclass(frozen=True, slots=True)
class Preset:
    """Device with the numbers of its data sheet.

    Attributes:
        name: maker's name of the device. Several presets share a name if the device contains several sensors.
        kind: kind of sensor; `lidar` includes `ray`, `gpu_lidar` and `gpu_ray`.
        maker: manufacturer or vendor.
        source: data sheet, its revision if known, and the place of the numbers in it.
        settings: elements of the sensor, in SI units: its block, and elements beside the block such as `latency` and
            artefacts.
        rate: samples per second [Hz]; 0 if the data sheet leaves the rate to the user.
        aliases: other names of the same device.
        remark: properties that the numbers omit, or the derivation of a number from a published one.
        unconfirmed: elements whose numbers have only one source, with parent elements where the name is ambiguous.
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
        """`<sensor type>` names that may use the preset."""
        return SENSOR_KINDS.get(self.kind, (self.kind,))

    @property
    def block(self) -> str:
        """Name of the element that contains the settings."""
        return block_of(self.kind)

    @property
    def elements(self) -> Settings:
        """All elements: the settings, and the rate if the preset has one."""
        return {"update_rate": self.rate, **self.settings} if self.rate else self.settings

    @property
    def beside(self) -> Settings:
        """Elements beside the sensor's block: its sweep, its latency and its artefacts."""
        return {name: value for name, value in self.settings.items() if name != self.block}


def block_of(kind: str) -> str:
    """Return the name of the element that contains the settings of a kind."""
    return _BLOCKS.get(kind, kind)


def load_presets() -> Iterator[Preset]:
    """Read every preset, file by file.

    Raises:
        TypeError: a preset has an unknown key or lacks one.
    """
    folders = (_FOLDER, *map(Path, pack_folders("sensors/presets/data")))
    for file in (file for folder in folders for file in sorted(folder.glob("*.toml"))):
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
    """Return the settings on one line; neighbours with equal settings, such as the axes of an IMU, are merged."""
    return ", ".join(_outline_items(settings))


def _outline_items(settings: Settings) -> list[str]:
    names: dict[str, list[str]] = {}
    listed = {name: value for name, value in settings.items() if not str(value).startswith("gaussian")} or settings
    for name, value in listed.items():
        if isinstance(value, Mapping):
            children = _outline_items(value) or [""]
            text = f" ({', '.join(children)})" if len(children) > 1 else f" {children[0]}".rstrip()
            names.setdefault(text, []).append(name)
        elif isinstance(value, list) and value and isinstance(value[0], (Mapping, list)):
            names[f"{counted(len(value), 'element')} {name}"] = []
        elif len(format_value(value).split()) > _LONGEST_LIST:
            names[f"{name} of {counted(len(format_value(value).split()), 'number')}"] = []
        else:
            names[f"{name} {format_value(value)}".removeprefix("@")] = []
    return ["/".join(merged_names) + text for text, merged_names in names.items()]


def format_value(value: object) -> str:
    """Return a value as it is written in a file: a number with all its digits, `true` or `false`, a list in a row."""
    if isinstance(value, list):
        return " ".join(map(format_value, value))
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}" if float(f"{value:.6g}") == value else repr(value)
    return str(value)
