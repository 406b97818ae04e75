"""Lights of the file as MuJoCo's lights."""

from __future__ import annotations

import math
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Pose
from simkit.scene import SceneLight

FARTHEST: Final = 100.0
"""Directional lights are drawn from at most this far [m]: their place only frames the shadow map."""

_FARTHEST_LAMP: Final = 1e4


def drawn_position(light: SceneLight, position: Any) -> npt.NDArray[np.float64]:
    """Where MuJoCo draws a light from: its position, pulled in along the line to the origin when it is far away.

    Suns at 256e9 m, which worlds have, overflow the renderer's matrices.
    """
    place = np.asarray(position, float)
    most = FARTHEST if light.type == "directional" else _FARTHEST_LAMP
    length = float(np.linalg.norm(place))
    return place * (most / length) if length > most else place


def add_light(body: Any, light: SceneLight, pose: Pose, shadows: bool) -> None:
    """Adds a light at `pose` in the frame of `body`."""
    made = body.add_light(name=light.scoped)
    made.type = {
        "directional": mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        "spot": mujoco.mjtLightType.mjLIGHT_SPOT,
    }.get(light.type, mujoco.mjtLightType.mjLIGHT_POINT)
    made.pos = drawn_position(light, pose.position)
    made.dir = pose.rotate(light.direction)
    made.active = light.on
    made.castshadow = bool(shadows and light.cast_shadows)
    made.ambient = (0.0, 0.0, 0.0)
    made.diffuse = np.clip(np.asarray(light.diffuse[:3]) * light.intensity, 0.0, 10.0)
    made.specular = np.clip(np.asarray(light.specular[:3]) * light.intensity, 0.0, 10.0)
    if light.type != "directional":
        reach, constant, linear, quadratic = light.attenuation
        made.range = max(reach, 1e-3)
        made.attenuation = (constant, linear, quadratic) if constant + linear + quadratic > 0.0 else (1.0, 0.0, 0.0)
    if light.type == "spot":
        _, outer, falloff = light.spot
        made.cutoff = min(90.0, max(1.0, math.degrees(outer) / 2))
        made.exponent = max(0.0, falloff)
