"""One spelling for the many names that files give to one plugin."""

from __future__ import annotations

import re
from typing import Final

from simkit.scene import ScenePlugin

ENTRY_POINT_GROUP: Final = "simkit.plugins"
"""Group of the entry points by which installed packages offer plugins."""


def normalise(name: str) -> str:
    """One spelling for the many of one plugin: `libignition-gazebo6-imu-system.so` is `gz-sim-imu-system`.

    Folder, `lib` and the library's ending go; Ignition's names and version numbers become gz-sim's.
    """
    stem = name.strip().replace("\\", "/").rsplit("/", 1)[-1]
    stem = re.sub(r"\.(so|dylib|dll)(\.\d+)*$", "", stem)
    stem = stem.removeprefix("lib")
    stem = re.sub(r"^(ignition-gazebo|gz-sim)\d*(-|$)", r"gz-sim\2", stem)
    return re.sub(r"^(ignition::gazebo|gz::sim)::(v\d+::)?", "gz::sim::", stem)


def aliases(plugin: ScenePlugin) -> list[str]:
    """The normalised names a plugin of a file may be known by: its library, then its gz class.

    A name without `::` is only what the file's author called it.
    """
    names = [plugin.filename, plugin.name if "::" in plugin.name else ""]
    return [normalise(name) for name in names if name]
