"""Normalised names of plugins: files name the same plugin in many ways."""

from __future__ import annotations

import re
from typing import Final

from simkit.scene import ScenePlugin

ENTRY_POINT_GROUP: Final = "simkit.plugins"
"""Entry point group in which installed packages offer plugins."""


def normalise(name: str) -> str:
    """Return the common spelling of a plugin's name: `libignition-gazebo6-imu-system.so` is `gz-sim-imu-system`.

    Folder, `lib` and the library's suffix are removed; Ignition's names and version numbers become gz-sim's.
    """
    stem = name.strip().replace("\\", "/").rsplit("/", 1)[-1]
    stem = re.sub(r"\.(so|dylib|dll)(\.\d+)*$", "", stem)
    stem = stem.removeprefix("lib")
    stem = re.sub(r"^(ignition-gazebo|gz-sim)\d*(-|$)", r"gz-sim\2", stem)
    return re.sub(r"^(ignition::gazebo|gz::sim)::(v\d+::)?", "gz::sim::", stem)


def aliases(plugin: ScenePlugin) -> list[str]:
    """Return the normalised names under which a plugin of a file may be known: its library, then its gz class.

    A name without `::` is only a label chosen by the author of the file.
    """
    names = [plugin.filename, plugin.name if "::" in plugin.name else ""]
    return [normalise(name) for name in names if name]
