"""Names of Gazebo's plugins, and the reasons why simkit does not support some of them.

The data is in `unsupported_plugins.toml`.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from types import MappingProxyType
from typing import Final

_TABLE: Final = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))

GAZEBO_PLUGINS: frozenset[str] = frozenset(
    [f"gz-sim-{name}-system" for name in _TABLE["gz_systems"].split()]
    + [f"gazebo_ros_{name}" for name in _TABLE["classic_ros"].split()]
    + _TABLE["control"].split()
    + _TABLE["classic"].split()
)
"""Library names of Gazebo's plugins, normalised by `simkit.plugins.plugin_names.normalise`."""


def _reasons_by_name() -> dict[str, str]:
    found: dict[str, str] = {}
    for row in _TABLE["gz"]:
        for file_and_class in row["names"].split():
            part, _, cls = file_and_class.partition(":")
            found[f"gz-sim-{part}-system"] = found[f"gz::sim::systems::{cls}"] = row["reason"]
    for row in _TABLE["libraries"]:
        found.update(dict.fromkeys(row["names"].split(), row["reason"]))
    return found


UNSUPPORTED_REASONS: Final = MappingProxyType(_reasons_by_name())
"""Reason by library name or gz class name; the names are normalised by `simkit.plugins.plugin_names.normalise`."""
