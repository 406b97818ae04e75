"""Normalisation of plugin names, because files spell the name of a plugin in many ways."""

from __future__ import annotations

import re
from typing import Final

from simkit.scene import ScenePlugin

ENTRY_POINT_GROUP: Final = "simkit.plugins"
"""Group of entry points with which installed Python packages provide plugins."""


def normalise(name: str) -> str:
    """Return the normalised spelling of a plugin's name: `gz-sim-imu-system` for `libignition-gazebo6-imu-system.so`.

    The folder, `lib`, the suffix of the library and version numbers are removed. Ignition's names become gz-sim names.
    """
    stem = name.strip().replace("\\", "/").rsplit("/", 1)[-1]
    stem = re.sub(r"\.(so|dylib|dll)(\.\d+)*$", "", stem)
    stem = stem.removeprefix("lib")
    stem = re.sub(r"^(ignition-gazebo|gz-sim)\d*(-|$)", r"gz-sim\2", stem)
    return re.sub(r"^(ignition::gazebo|gz::sim)::(v\d+::)?", "gz::sim::", stem)


def aliases(plugin: ScenePlugin) -> list[str]:
    """Return the normalised names of a plugin in a file: the name of its library, then the name of its gz class.

    A `name` without `::` is not a gz class, but a label that the author of the file has chosen.
    """
    names = [plugin.filename, plugin.name if "::" in plugin.name else ""]
    return [normalise(name) for name in names if name]
