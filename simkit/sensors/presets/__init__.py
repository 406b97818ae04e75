"""Presets: a sensor names a real device, `<simkit:preset>LDS-01</simkit:preset>`, and gets its published numbers.

A `<sensor>` enters, the same sensor with the device's settings under its own leaves. The numbers are data: one TOML
file in `data/` for each maker or family. No code here knows a device.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from simkit.sensors.presets.preset import Preset, load_presets

__all__ = ["Preset", "find", "normalise_name", "presets"]


@functools.cache
def presets() -> tuple[Preset, ...]:
    """Every preset, by kind and name.

    Raises:
        RuntimeError: two of one kind answer to one name.
    """
    return tuple(sorted(load_presets(), key=lambda p: (p.kind, p.maker, p.name)))


@functools.cache
def _by_name() -> Mapping[str, Mapping[str, Preset]]:
    """Folded name -> kind -> preset."""
    table: dict[str, dict[str, Preset]] = {}
    for preset in presets():
        for name in (preset.name, *preset.aliases):
            of_name = table.setdefault(normalise_name(name), {})
            if of_name.setdefault(preset.kind, preset) is not preset:
                raise RuntimeError(f"{name!r} is {preset.name!r} and {of_name[preset.kind].name!r}")
    return table


def find(name: str) -> Mapping[str, Preset]:
    """The presets of that name by their kind; empty where there is none.

    Capitals, spaces and dashes do not count: `tim571` is `TiM571`.
    """
    return _by_name().get(normalise_name(name), {})


def normalise_name(name: str) -> str:
    """A name as it is compared with others."""
    return re.sub(r"[^0-9a-z]", "", name.lower())
