"""Load the presets from the TOML files in `data/`, one file for each maker or family.

Keys above the first `[[preset]]` of a file hold for all presets of that file. Settings are in SI units; `xyz` and `xy`
stand for axes with the same settings. A comment gives the number of the data sheet where its unit differs.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from simkit.sensors.presets.preset import Preset, Settings

_FOLDER: Final = Path(__file__).parent / "data"
_AXES: Final = ("xyz", "xy")


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
