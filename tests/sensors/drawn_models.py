"""Images of small MuJoCo models, drawn by one renderer or the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.geom_groups import VISUAL
from simkit.scene import Surroundings
from simkit.sensors.cameras.depth_range import clip_planes
from simkit.sensors.cameras.rendering.appearance import QUALITIES, Appearance
from simkit.sensors.cameras.rendering.renderer import Renderer
from simkit.sensors.cameras.rendering.software.software_renderer import SoftwareRenderer
from simkit.sensors.cameras.rendering.view import DrawnView, Shot, View, depth_line, look_at

Depths = npt.NDArray[np.float64]
SUN: Final = '<light type="directional" dir="-.4 .3 -1" diffuse=".6 .6 .5" specular=".4 .4 .4"/>'
AMBIENT: Final = (
    '<visual><headlight ambient="{0} {0} {0}" diffuse="0 0 0" specular="0 0 0"/><map znear="0.01"/></visual>'
)


def model(bodies: str, assets: str = "", lights: str = SUN, ambient: float = 0.3) -> mujoco.MjModel:
    """Return a model whose geoms are visuals."""
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><compiler autolimits="true"/>{AMBIENT.format(ambient)}
        <default><geom group="{VISUAL}" contype="0" conaffinity="0"/></default>
        <asset>{assets}</asset><worldbody>{lights}{bodies}</worldbody></mujoco>"""
    )


def view(width: int = 160, height: int = 120, left: float = -0.6, right: float = 0.6, far: float = 60.0) -> View:
    """Return a view with square pixels whose vertical middle is straight ahead."""
    half = (right - left) / 2 * height / width
    near, beyond = clip_planes(0.05, far)
    return View(width, height, left, right, -half, half, near, beyond)


def draw(
    kind: type[SoftwareRenderer] | type[Renderer],
    world: mujoco.MjModel,
    shot: Shot,
    eye: tuple[float, float, float],
    target: tuple[float, float, float],
    *,
    quality: str = "fast",
    surroundings: Surroundings | None = None,
    decorate: Callable[[mujoco.MjvScene], None] | None = None,
    data: mujoco.MjData | None = None,
) -> DrawnView:
    """Return a drawn view of a model, whose arrays nothing overwrites."""
    renderer = kind(Appearance(surroundings or Surroundings(), QUALITIES[quality]))
    if data is None:
        data = mujoco.MjData(world)
        mujoco.mj_forward(world, data)
    place = np.array(eye, np.float64)
    composition = renderer.composer.compose(world, data, place, look_at(place, np.array(target, np.float64)), decorate)
    found = renderer.draw(composition, shot)
    copies: dict[str, Any] = {
        name: None if values is None else values.copy()
        for name, values in (("colours", found.colours), ("depths", found.depths), ("ids", found.ids))
    }
    renderer.free()
    return DrawnView(found.view, **copies)


def metres(found: DrawnView) -> Depths:
    """Return the depths along the axis [m], infinite without a shape."""
    assert found.depths is not None
    slope, offset = (float(number) for number in depth_line(found.view.near, found.view.far))
    raw = found.depths.astype(np.float64)
    return np.where(raw > 0.0, slope / np.where(raw > 0.0, raw + offset, 1.0), np.inf)


def rays(seen: View) -> tuple[Depths, Depths]:
    """Return the tangents of each pixel to the right and upwards."""
    x = seen.left + (np.arange(seen.width) + 0.5) * (seen.right - seen.left) / seen.width
    y = seen.top - (np.arange(seen.height) + 0.5) * (seen.top - seen.bottom) / seen.height
    right, up = np.meshgrid(x, y)
    return right, up
