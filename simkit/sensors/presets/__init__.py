"""Presets: a sensor names a real device, `<simkit:preset>LDS-01</simkit:preset>`, and gets its published numbers.

Input is a `<sensor>`. Output is the same sensor with the device's settings as defaults. The numbers are data: one TOML
file in `data/` for each maker or family. The code contains no device.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from simkit.sensors.presets.preset import Preset, load_presets

__all__ = ["Preset", "find", "normalise_name", "presets"]


@functools.cache
def presets() -> tuple[Preset, ...]:
    """Return every preset, sorted by kind, maker and name.

    Raises:
        TypeError: a preset has an unknown key or lacks one.
    """
    return tuple(sorted(load_presets(), key=lambda p: (p.kind, p.maker, p.name)))


@functools.cache
def _by_name() -> Mapping[str, Mapping[str, Preset]]:
    """Return the presets by normalised name and kind.

    Raises:
        RuntimeError: two presets of one kind have the same name.
    """
    table: dict[str, dict[str, Preset]] = {}
    for preset in presets():
        for name in (preset.name, *preset.aliases):
            presets_by_kind = table.setdefault(normalise_name(name), {})
            if presets_by_kind.setdefault(preset.kind, preset) is not preset:
                raise RuntimeError(f"presets {preset.name!r} and {presets_by_kind[preset.kind].name!r} share {name!r}")
    return table


def find(name: str) -> Mapping[str, Preset]:
    """Return the presets of a name by their kind; empty if there is none.

    Capitals, spaces and dashes are ignored: `tim571` finds `TiM571`.
    """
    return _by_name().get(normalise_name(name), {})


def normalise_name(name: str) -> str:
    """Return a name in the form in which names are compared: lower case, letters and digits only."""
    return re.sub(r"[^0-9a-z]", "", name.lower())
