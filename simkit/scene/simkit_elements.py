"""Elements of our own: what a file may say that SDF has no word for.

They are read by their plain name and with our prefix, `<latency>` and `<simkit:latency>`; written they are with the
prefix, over which Gazebo passes without a word.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

PREFIX: Final = "simkit:"

OWN_ELEMENTS: Final[Mapping[str, frozenset[str]]] = MappingProxyType(
    {
        "world": frozenset({"gazebo_quirks"}),
        "actor": frozenset({"person"}),
        "scene": frozenset({"quality"}),
        "light": frozenset({"irradiance"}),
        "sensor": frozenset(
            {"encoder", "jitter", "latency", "latency_jitter", "phase", "preset", "set_rate_topic", "solar"}
        ),
        "noise": frozenset({"bias_instability", "correlation_time", "noise_density", "random_walk"}),
        "camera": frozenset({"disparity_noise"}),
        "imu": frozenset({"orientation"}),
        "magnetometer": frozenset({"date"}),
        "sonar": frozenset({"axis", "noise"}),
        "plugin": frozenset(
            {"controllers", "interpolation", "odometry_noise", "on_error", "point_times", "pose_type"}
            | {"ros2_control", "shadow_gz"}
        ),
    }
)
"""Element of SDF -> names in it that are our own. What is inside one of our own, or of a plugin's, needs no prefix."""


def written_name(name: str, parent: str) -> str:
    """The name of an element as a file for Gazebo has it: with our prefix where it is our own."""
    return PREFIX + name if name in OWN_ELEMENTS.get(parent, ()) else name
