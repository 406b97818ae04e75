"""Worlds with a lidar that sweeps on a body that moves and turns, without gravity."""

from __future__ import annotations

import math
from typing import Any

from sensor_worlds import box

INERTIA = (
    "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
    "<gravity>false</gravity>"
)
POSE = "0.3 -0.2 0.4 0.2 -0.1 0.5"
LINEAR, ANGULAR = (0.8, -0.5, 0.2), (0.3, -0.4, 2.0)


def fan(columns: int, layers: int = 1, kind: str = "lidar", elevation: float = 0.3) -> str:
    block = kind.removeprefix("gpu_")
    layered = (
        f"<vertical><samples>{layers}</samples><min_angle>{-elevation}</min_angle>"
        f"<max_angle>{elevation}</max_angle></vertical>"
        if layers > 1
        else ""
    )
    last = math.pi - 2 * math.pi / columns
    return (
        f"<{block}><scan><horizontal><samples>{columns}</samples><min_angle>{-math.pi!r}</min_angle>"
        f"<max_angle>{last!r}</max_angle></horizontal>{layered}</scan>"
        f"<range><min>0.05</min><max>20</max></range></{block}>"
    )


def flyer(lidar: str, *, pose: str = "0 0 1 0 0 0") -> str:
    return f'<model name="m"><pose>{pose}</pose><link name="l">{INERTIA}{lidar}</link></model>'


def target(name: str, geometry: str, pose: str) -> str:
    shape = f"<geometry>{geometry}</geometry>"
    parts = f'<collision name="c">{shape}</collision><visual name="v">{shape}</visual>'
    return f'<model name="{name}"><pose>{pose}</pose><link name="l">{INERTIA}{parts}</link></model>'


def world(*parts: str, step: float = 0.002) -> str:
    physics = f'<physics type="ode"><max_step_size>{step}</max_step_size></physics>'
    return f'<sdf version="1.9"><world name="w">{physics}{"".join(parts)}</world></sdf>'


WALL = box("wall", "4 0 0 0 0 0.2", "0.2 30 30")
SWEEP = "<simkit:sweep>true</simkit:sweep>"


def launch(sim: Any, model: str, linear: tuple[float, ...], angular: tuple[float, ...]) -> None:
    """Set the velocity of a free link: linear in the world [m/s], angular in the link's own frame [rad/s]."""
    body = sim.engine.names.link(f"{model}::l").body
    first = int(sim.mj_model.body_dofadr[body])
    sim.mj_data.qvel[first : first + 6] = (*linear, *angular)
    sim.engine.physics.changed(3)
