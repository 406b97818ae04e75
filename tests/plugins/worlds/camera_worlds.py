"""Small worlds for the tests of camera plugins, as text, and what is heard in them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import simkit

WIDTH, HEIGHT, HFOV = 32, 24, 1.2
FOCAL = WIDTH / (2 * math.tan(HFOV / 2))
IMAGE = f"<horizontal_fov>{HFOV}</horizontal_fov><image><width>{WIDTH}</width><height>{HEIGHT}</height>%s</image>"
CAMERA = f"<camera>{IMAGE % ''}</camera>"
STEREO = (
    f'<camera name="left"><pose>0 0.05 0 0 0 0</pose>{IMAGE % ""}</camera>'
    f'<camera name="right"><pose>0 -0.05 0 0 0 0</pose>{IMAGE % ""}</camera>'
)


def wall(x: float, y: float, width: float, colour: str) -> str:
    """Its front is `x` in front of the camera; from `y` on to the left."""
    shape = f"<geometry><box><size>1 {width} 9</size></box></geometry>"
    look = f"<material><ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse></material>"
    name = f"wall_{y}_{x}".replace(".", "_").replace("-", "m")
    pose = f"<pose>{x + 0.5} {y + width / 2} 0 0 0 0</pose>"
    return (
        f'<model name="{name}"><static>true</static>{pose}<link name="l"><visual name="v">{shape}{look}</visual>'
        "</link></model>"
    )


WALLS = wall(0.25, 0.08, 0.4, "0 1 0") + wall(3.0, -9.0, 8.9, "1 0 0") + wall(6.0, -1.0, 9.0, "0 0 1")
"""Near on the left, 3 m away on the right, 6 m in between."""


def world(kind: str, block: str, plugin: str, *, rate: float = 50, model: str = "", extra: str = "") -> str:
    return f"""<sdf version="1.6"><world name="w"><scene><ambient>1 1 1 1</ambient></scene>{extra}
      <model name="m"><static>true</static><link name="eye_link">
        <sensor name="eye" type="{kind}"><update_rate>{rate}</update_rate>{block}{plugin}</sensor>
      </link>{model}</model>{WALLS}</world></sdf>"""


def plugin(library: str, content: str = "") -> str:
    return f'<plugin name="driver" filename="lib{library}.so">{content}</plugin>'


def topics_of(sim: Any) -> dict[str, str]:
    others = {"/clock", "/tf_static", *sim.communication.bus.aside}
    return {t: kind.rsplit("/", 1)[-1] for t, kind in sim.topics().items() if t not in others}


def heard(text: str, *topics: str, duration: float = 0.015) -> list[Any]:
    with simkit.load(text) as sim:
        subs = [sim.subscribe(t) for t in topics]
        sim.run(duration)
        return [sub.latest for sub in subs]


def codes(text: str) -> set[str]:
    with simkit.load(text) as sim:
        return {d.code for d in sim.diagnostics}


def points_of(cloud: Any) -> np.ndarray:
    dtype = np.dtype(
        {
            "names": [f.name for f in cloud.fields],
            "formats": ["<f4"] * len(cloud.fields),
            "offsets": [f.offset for f in cloud.fields],
            "itemsize": cloud.point_step,
        }
    )
    return np.frombuffer(np.asarray(cloud.data).tobytes(), dtype).reshape(cloud.height, cloud.width)
