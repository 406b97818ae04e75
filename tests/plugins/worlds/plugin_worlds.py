"""Small worlds for the plugin tests, as text."""

from __future__ import annotations

from typing import Any

import numpy as np

GROUND = """
<model name="ground"><static>true</static><link name="link"><collision name="plane"><geometry><plane/></geometry>
<surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface></collision></link></model>"""


def world(*parts: str, step: float = 0.001, name: str = "lab") -> str:
    physics = f"<physics type='ode'><max_step_size>{step}</max_step_size></physics>"
    return f"<sdf version='1.9'><world name='{name}'>{physics}{''.join(parts)}</world></sdf>"


def _link(name: str, pose: str, mass: float, shape: str, mu: float = 1.0) -> str:
    # of a solid ball's size, near enough for a test and always a possible inertia
    inertia = "".join(f"<{axis}>{0.004 * mass}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    surface = f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"
    return (
        f"<link name='{name}'><pose>{pose}</pose><inertial><mass>{mass}</mass><inertia>{inertia}</inertia></inertial>"
        f"<collision name='shape'><geometry>{shape}</geometry>{surface}</collision></link>"
    )


def rover(plugins: str = "", name: str = "rover", pose: str = "0 0 0 0 0 0", extra: str = "") -> str:
    """A box on two round wheels (radius 0.1 m, 0.4 m apart, under the origin) and two smooth casters."""
    wheel = "<sphere><radius>0.1</radius></sphere>"  # one point of contact: turns about the middle without scrub
    caster = "<sphere><radius>0.04</radius></sphere>"
    parts = [
        _link("base", "0 0 0.13 0 0 0", 4, "<box><size>0.4 0.3 0.06</size></box>"),
        _link("left", "0 0.2 0.1 -1.5707963267948966 0 0", 0.5, wheel),
        _link("right", "0 -0.2 0.1 -1.5707963267948966 0 0", 0.5, wheel),
        _link("front", "0.18 0 0.04 0 0 0", 0.1, caster, mu=0),
        _link("rear", "-0.18 0 0.04 0 0 0", 0.1, caster, mu=0),
    ]
    joints = [
        f"<joint name='{side}_wheel' type='revolute'><parent>base</parent><child>{side}</child><axis><xyz>0 0 1</xyz>"
        "<limit><lower>-1e16</lower><upper>1e16</upper></limit></axis></joint>"
        for side in ("left", "right")
    ] + [
        f"<joint name='{end}_weld' type='fixed'><parent>base</parent><child>{end}</child></joint>"
        for end in ("front", "rear")
    ]
    return f"<model name='{name}'><pose>{pose}</pose>{''.join(parts + joints)}{extra}{plugins}</model>"


def classic_drive(**values: Any) -> str:
    """`libgazebo_ros_diff_drive.so` for the rover, ROS 2 spelling."""
    settings = {
        "ros": "",
        "left_joint": "left_wheel",
        "right_joint": "right_wheel",
        "wheel_separation": 0.4,
        "wheel_diameter": 0.2,
        "max_wheel_torque": 20,
        "publish_odom": "true",
        **values,
    }
    return element("plugin", settings, "name='drive' filename='libgazebo_ros_diff_drive.so'")


def gz_drive(**values: Any) -> str:
    """gz's DiffDrive for the rover."""
    settings = {
        "left_joint": "left_wheel",
        "right_joint": "right_wheel",
        "wheel_separation": 0.4,
        "wheel_radius": 0.1,
        **values,
    }
    return element("plugin", settings, "name='gz::sim::systems::DiffDrive' filename='gz-sim-diff-drive-system'")


def element(name: str, values: dict[str, Any], attributes: str = "") -> str:
    inner = "".join(f"<{k}>{v}</{k}>" for k, v in values.items() if v is not None)
    return f"<{name} {attributes}>{inner}</{name}>"


def stamps(messages: list[Any]) -> np.ndarray:
    """Header stamps [ns]."""
    return np.array([m.header.stamp.sec * 1_000_000_000 + m.header.stamp.nanosec for m in messages])


def xyz(vector: Any) -> np.ndarray:
    return np.array([vector.x, vector.y, vector.z])


def yaw(quaternion: Any) -> float:
    """Of a level orientation [rad]."""
    return float(2 * np.arctan2(quaternion.z, quaternion.w))
