"""Parameters of Nav2's costmap nodes as parameters of `Costmap2D`, with Nav2's defaults where they differ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from simkit_navigation.plugins.costmaps.costmap_layers import DEFAULT_LAYERS, LAYERS
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, block_of, names_of

_COSTMAP: Final[Values] = {
    "robot_base_frame": "base_link",
    "footprint_padding": 0.01,
    "always_send_full_costmap": False,
}
_OBSERVING: Final[Values] = {"observation_sources": "", "min_obstacle_height": 0.0, "max_obstacle_height": 2.0}
_SOURCE: Final[Values] = {"clearing": False, "min_obstacle_height": 0.0, "max_obstacle_height": 0.0}
"""Defaults of Humble and Jazzy: nav2_costmap_2d/src/costmap_2d_ros.cpp, plugins/obstacle_layer.cpp, voxel_layer.cpp."""
_PACKAGE: Final = "nav2_costmap_2d::"
_ENABLED_BY_LAUNCH: Final = ("KEEPOUT_ZONE_ENABLED", "SPEED_ZONE_ENABLED")
"""Values of `enabled` which the launch file of nav2_bringup replaces, by true unless its arguments say otherwise.

Source: nav2_bringup/launch/bringup_launch.py of Kilted and later, use_keepout_zones and use_speed_zones.
"""
_DATA_TYPES: Final = ("LaserScan", "PointCloud2")


def costmap_parameters(values: Mapping[str, object]) -> NodeValues:
    """Return the parameters of a `Costmap2D`.

    Args:
        values: parameters of a costmap node of Nav2; blocks are dictionaries.
    """
    told: list[str] = []
    result: Values = {**_COSTMAP, **{name: value for name, value in values.items() if value is not None}}
    kept: dict[str, list[str]] = {}
    blocks: list[str] = []
    for key in ("plugins", "filters"):
        listed = names_of(values.get(key))
        kept[key] = []
        for name in listed or (DEFAULT_LAYERS if key == "plugins" else ()):
            if not listed and not isinstance(values.get(name), dict):
                continue  # a layer of simkit's own list with simkit's defaults
            settings = block_of(values, name)
            kind = str(settings.get("plugin") or DEFAULT_LAYERS.get(name, "")).replace("/", "::")
            if kind.startswith(_PACKAGE) and kind not in LAYERS:
                told.append(f"{name}: the {'filter' if key == 'filters' else 'layer'} {kind} is left out")
                result.pop(name, None)
                continue
            result[name], sources = _layer(name, kind, settings, values, told)
            kept[key].append(name)
            blocks += [name, *sources]
        if listed:
            result[key] = kept[key]
    for name, block in values.items():  # a block of a layer that is not in a list has no effect in Nav2, either
        is_layer = isinstance(block, dict) and ("plugin" in block or name in DEFAULT_LAYERS)
        if is_layer and names_of(values.get("plugins")) and name not in blocks:
            result.pop(name, None)
    return NodeValues(result, blocks, told)


def _layer(
    name: str, kind: str, settings: Values, values: Mapping[str, object], told: list[str]
) -> tuple[Values, list[str]]:
    """Return the settings of a layer with Nav2's defaults, and the names of its sources."""
    if kind == f"{_PACKAGE}StaticLayer" and not settings.get("map_topic") and values.get("map_topic"):
        settings["map_topic"] = values["map_topic"]
    if settings.get("enabled") in _ENABLED_BY_LAUNCH:
        settings["enabled"] = True
    if kind not in (f"{_PACKAGE}ObstacleLayer", f"{_PACKAGE}VoxelLayer"):
        return settings, []
    settings = {**_OBSERVING, **settings}
    sources = []
    for source in names_of(settings["observation_sources"]):
        own: Values = {"topic": source, **_SOURCE, **block_of(settings, source)}
        if own.get("data_type", "LaserScan") not in _DATA_TYPES:
            told.append(f"{name}: the source {source} is left out: its data_type is not {' or '.join(_DATA_TYPES)}")
            settings.pop(source, None)
            continue
        settings[source] = own
        sources.append(source)
    settings["observation_sources"] = " ".join(sources)
    return settings, sources
