"""Lights of a picture, and where their shadow maps are drawn from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.lights import MOST_LIGHTS
from simkit.pose import Vector
from simkit.sensors.temporary_values import temporary_values

_AHEAD: Final = 3.0  # [m]; what a camera looks at lies about there
_REACH: Final = 15.0  # [m]; shadows around a camera, where the scene is larger
_DIRECTIONAL = int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
_LIGHT_FIELDS: Final = ("light_pos", "light_dir", "light_active")  # what a light's handle writes

Lights = Sequence[Vector]
"""How the lights of a model stood and shone at one time."""


def read_lights(model: mujoco.MjModel) -> Lights:
    """How the lights of a model stand and shine now."""
    return [getattr(model, field).copy() for field in _LIGHT_FIELDS]


@contextmanager
def use_lights(model: mujoco.MjModel, data: mujoco.MjData, lights: Lights) -> Iterator[None]:
    """While it lasts, the lights of a model, and of data computed of it, are as they were."""
    now = read_lights(model)
    is_same = all(np.array_equal(*pair) for pair in zip(lights, now, strict=True))
    if not is_same:
        _write_lights(model, data, lights)
    try:
        yield
    finally:
        if not is_same:
            _write_lights(model, data, now)


def _write_lights(model: mujoco.MjModel, data: mujoco.MjData, lights: Lights) -> None:
    for field, values in zip(_LIGHT_FIELDS, lights, strict=True):
        getattr(model, field)[:] = values
    options = model.opt
    flags = options.enableflags
    options.enableflags = flags & ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)  # else those of the world stay
    mujoco.mj_camlight(model, data)
    options.enableflags = flags


@contextmanager
def keep_strongest_lights(
    model: mujoco.MjModel, data: mujoco.MjData, position: Vector, rotation: Vector
) -> Iterator[None]:
    """While it lasts, only so many lights of the model shine as can be drawn: those that a camera gets most of.

    Suns come first. Lamps follow by what they give a surface at the camera or a little ahead of it.
    """
    active = model.light_active
    shining = np.flatnonzero(active)
    if len(shining) <= MOST_LIGHTS:
        yield
        return
    strength = np.asarray(model.light_diffuse)[shining].max(axis=1).astype(np.float64)
    constant, linear, quadratic = np.asarray(model.light_attenuation)[shining].T
    places, best = np.asarray(data.light_xpos)[shining], np.zeros(len(shining))
    for ahead in (0.0, _AHEAD):
        far = np.linalg.norm(places - (position + ahead * rotation[:, 0]), axis=1)
        share = 1.0 / np.maximum(constant + far * (linear + far * quadratic), 1e-6)
        best = np.maximum(best, np.where(far <= np.asarray(model.light_range)[shining], share, 1e-6 * share))
    suns = np.asarray(model.light_type)[shining] == _DIRECTIONAL
    order = np.argsort(-np.where(suns, 1e9 * strength, strength * best), kind="stable")
    with temporary_values(active, shining[order[MOST_LIGHTS:]], 0):
        yield


def convert_point_lights(scene: mujoco.MjvScene) -> None:
    """Point lights of MuJoCo's own format, which its rasteriser leaves out, as spots that are open all around."""
    for light in scene.lights[: scene.nlight]:
        if light.type == mujoco.mjtLightType.mjLIGHT_POINT:
            light.type, light.cutoff, light.exponent = mujoco.mjtLightType.mjLIGHT_SPOT, 180.0, 0.0
            light.castshadow = 0


def place_directional_lights(
    scene: mujoco.MjvScene,
    context: mujoco.MjrContext,
    model: mujoco.MjModel,
    position: Vector,
    forward: Vector,
    far: float,
) -> None:
    """Puts directional lights where their shadow maps cover what a view looks at.

    The maps are as deep as the view, from the light's place on. A scene that is small enough is covered whole; of a
    larger one what lies ahead of the camera, moved in whole pixels of the map, so that shadows stand still.
    """
    suns = [li for li in scene.lights[: scene.nlight] if li.type == _DIRECTIONAL and not li.headlight and li.castshadow]
    if not suns:
        return
    extent, middle = float(model.stat.extent), np.asarray(model.stat.center)
    reach = min(extent, _REACH, far / 2)
    is_whole = reach >= extent
    context.shadowClip = reach
    if not is_whole:
        middle = position + 0.8 * reach * forward
    back = min(far - reach, extent + reach)
    for light in suns:
        direction = np.asarray(light.dir, dtype=np.float64)
        place = middle if is_whole else _snap_to_pixel_grid(middle, direction, 2.0 * reach / context.shadowSize)
        light.pos = place - back * direction


def fit_shadow_maps(context: mujoco.MjrContext) -> None:
    """Lets the engine read a shadow map where it has drawn it: within a border of one pixel, which it forgets.

    Without it, what is read lies up to a pixel away from the surface that asks, at the map's border. That is more than
    the engine allows for: sunlit ground throws dots of shadow on itself.
    """
    from OpenGL import GL

    pixel = 1.0 / context.shadowSize
    inside = 1.0 - 2.0 * pixel
    columns = (inside, 0.0, 0.0, 0.0, 0.0, inside, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, pixel, pixel, 0.0, 1.0)
    GL.glActiveTexture(GL.GL_TEXTURE1)  # which the engine uses for shadows alone
    GL.glMatrixMode(GL.GL_TEXTURE)
    GL.glLoadMatrixf(np.array(columns, dtype=np.float32))
    GL.glMatrixMode(GL.GL_MODELVIEW)
    GL.glActiveTexture(GL.GL_TEXTURE0)


def _snap_to_pixel_grid(place: Vector, direction: Vector, pixel: float) -> Vector:
    """The point on a grid [m] fixed in the world, across a direction."""
    side = np.cross(direction, (0.0, 0.0, 1.0) if abs(direction[2]) < 0.9 else (1.0, 0.0, 0.0))
    side /= np.linalg.norm(side)
    up = np.cross(direction, side)
    moved: Vector = place.copy()
    for axis in (side, up):
        at = float(axis @ place)
        moved += (round(at / pixel) * pixel - at) * axis
    return moved
