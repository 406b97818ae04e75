"""Models that are moved by their velocity, for the tests of what moves them."""

from __future__ import annotations

import math

import numpy as np
from plugin_worlds import element

INERTIA = "<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>"
ARM = f"""
<link name='arm'><pose>0 0.3 0 0 0 0</pose><inertial><pose>0 0 -0.3 0 0 0</pose><mass>2</mass>{INERTIA}</inertial>
</link><joint name='hinge' type='continuous'><parent>base</parent><child>arm</child><axis><xyz>0 1 0</xyz></axis>
</joint>"""
WALL = """
<model name='wall'><static>true</static><pose>1 0 0.5 0 0 0</pose><link name='link'><collision name='c'><geometry>
<box><size>0.2 4 1</size></box></geometry></collision></link></model>"""


def box(plugins: str, name: str = "box", pose: str = "0 0 0.1 0 0 0", extra: str = "", mass: float = 5.0) -> str:
    """A box of 0.4 m by 0.3 m by 0.2 m; at its default pose it stands on the ground."""
    shape = "<collision name='c'><geometry><box><size>0.4 0.3 0.2</size></box></geometry></collision>"
    inertial = f"<inertial><mass>{mass}</mass>{INERTIA}</inertial>"
    return f"<model name='{name}'><pose>{pose}</pose><link name='base'>{inertial}{shape}</link>{extra}{plugins}</model>"


def velocity_control(inner: str = "") -> str:
    return (
        f"<plugin filename='gz-sim-velocity-control-system' name='gz::sim::systems::VelocityControl'>{inner}</plugin>"
    )


def planar_move(**values: object) -> str:
    return element("plugin", values, "name='move' filename='libgazebo_ros_planar_move.so'")


def arc(ahead: float, turn: float, time: float, aside: float = 0.0) -> np.ndarray:
    """Where a twist held in the body's axes leads from the origin: x, y [m] and yaw [rad]."""
    yaw = turn * time
    if turn == 0:
        return np.array((ahead * time, aside * time, 0.0))
    sin, cos = math.sin(yaw) / turn, (1 - math.cos(yaw)) / turn
    return np.array((ahead * sin - aside * cos, ahead * cos + aside * sin, yaw))
