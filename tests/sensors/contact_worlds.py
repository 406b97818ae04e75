"""Small worlds with touching models, and sums over the messages of contact sensors."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

G = 9.8
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
</collision></link></model>"""
SHAPES = {
    "box": "<box><size>0.2 0.2 0.2</size></box>",
    "sphere": "<sphere><radius>0.1</radius></sphere>",
    "cylinder": "<cylinder><radius>0.1</radius><length>0.2</length></cylinder>",
    "capsule": "<capsule><radius>0.05</radius><length>0.1</length></capsule>",
}


def contact(collisions: str = "c", rate: float = 0, more: str = "", name: str = "s") -> str:
    named = "".join(f"<collision>{c}</collision>" for c in collisions.split())
    head = f'<sensor name="{name}" type="contact"><update_rate>{rate}</update_rate>'
    return f"{head}<contact>{named}</contact>{more}</sensor>"


def body(
    name: str,
    pose: str = "0 0 0.1 0 0 0",
    shape: str = "box",
    *,
    mass: float = 1.0,
    sensor: str = "",
    friction: str = "",
    more: str = "",
) -> str:
    """Return a model with a link `l`, 0.2 m wide, and a collision `c`; `friction` is the content of `<friction>`."""
    moment = mass * 0.2**2 / 6
    inertia = "".join(f"<{axis}>{moment}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    surface = f"<surface><friction>{friction}</friction></surface>"
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l">
    <inertial><mass>{mass}</mass><inertia>{inertia}</inertia></inertial>
    <collision name="c"><geometry>{SHAPES.get(shape, shape)}</geometry>{surface}</collision>{sensor}</link>
    {more}</model>"""


def mu(value: float) -> str:
    return f"<ode><mu>{value}</mu><mu2>{value}</mu2></ode>"


def world(*parts: str, step: float = 0.001, top: str = "") -> str:
    physics = f'<physics type="x"><max_step_size>{step}</max_step_size></physics>'
    return f'<sdf version="1.9"><world name="w">{physics}{top}{"".join(parts)}</world></sdf>'


def topic(model: str, link: str = "l", sensor: str = "s") -> str:
    return f"/world/w/model/{model}/link/{link}/sensor/{sensor}/contact"


def xyz(message: Any) -> npt.NDArray[np.float64]:
    return np.array((message.x, message.y, message.z))


def total_force(message: Any) -> npt.NDArray[np.float64]:
    """Return the sum of all forces on the sensor's own collisions [N]."""
    forces = [xyz(w.body_1_wrench.force) for c in message.contacts for w in c.wrenches]
    return np.sum(forces, axis=0) if forces else np.zeros(3)


def names(message: Any) -> list[tuple[str, str]]:
    return [(c.collision1.name, c.collision2.name) for c in message.contacts]
