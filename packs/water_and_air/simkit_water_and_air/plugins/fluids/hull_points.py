"""Buoyancy of a slender hull: a half cylinder, divided into points along its length.

At each point, the depth h of the hull below the surface is limited to 0…R. With the radius R and the length L of a
part, its displaced volume is L · (R²·acos((R - h)/R) - (R - h)·√(2·R·h - h²)).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from simkit_water_and_air.plugins.fluids.tuple_vectors import Triple
from simkit_water_and_air.plugins.fluids.wave_field import WaveField

if TYPE_CHECKING:
    import mujoco


def segment_area(radius: float, height: float) -> float:
    """Return the area of the segment of a circle [m²].

    Args:
        radius: Radius of the circle [m].
        height: Height of the segment [m], from 0 to `radius`.
    """
    rest = radius - height
    return radius * radius * math.acos(rest / radius) - rest * math.sqrt(2 * radius * height - height * height)


def hull_wrench(
    data: mujoco.MjData,
    body: int,
    points: Sequence[Triple],
    radius: float,
    mass_per_area: float,
    level: float,
    waves: WaveField,
    time: float,
    gravity: Sequence[float],
) -> list[float]:
    """Return the buoyant force [N] and its torque about the centre of mass [N·m], in the world frame.

    Args:
        data: Engine data with computed poses.
        body: MuJoCo index of the link.
        points: Points of the hull in the link's frame [m].
        radius: Radius of the hull [m].
        mass_per_area: Density of the water times the length of a part [kg/m²].
        level: Mean height of the surface [m].
        waves: Waves of the surface.
        time: Time of the simulation [s].
        gravity: Gravity in the world frame [m/s²].
    """
    axes, (ox, oy, oz) = data.xmat[body].tolist(), data.xpos[body].tolist()
    cx, cy, cz = data.xipos[body].tolist()
    mass = mx = my = mz = 0.0
    for px, py, pz in points:
        x = ox + axes[0] * px + axes[1] * py + axes[2] * pz
        y = oy + axes[3] * px + axes[4] * py + axes[5] * pz
        z = oz + axes[6] * px + axes[7] * py + axes[8] * pz
        depth = min(level + waves.height(x, y, time) - z, radius)
        if depth > 0:
            part = mass_per_area * segment_area(radius, depth)
            mass += part
            mx, my, mz = mx + part * (x - cx), my + part * (y - cy), mz + part * (z - cz)
    gx, gy, gz = gravity
    return [-mass * gx, -mass * gy, -mass * gz, gy * mz - gz * my, gz * mx - gx * mz, gx * my - gy * mx]
