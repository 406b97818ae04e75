"""Lights of an image, and the positions from which their shadow maps are drawn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final, Protocol

import mujoco
import numpy as np

from simkit.compiler.lights import MOST_LIGHTS
from simkit.linear_algebra import matmul, norm
from simkit.pose import Vector
from simkit.sensors.values_with_expiry import temporary_values

_AHEAD: Final = 3.0  # [m] typical distance of the objects that a camera sees
_REACH: Final = 15.0  # [m] radius of shadows around a camera in a larger scene
_DIRECTIONAL = int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
_LIGHT_FIELDS: Final = ("light_pos", "light_dir", "light_active")  # fields that a light's handle modifies

Lights = Sequence[Vector]
"""Poses and states of the lights of a model at one time."""
Sphere = tuple[Vector, float]
"""Centre [m], shape (3,), and radius [m]."""


class ShadowSettings(Protocol):
    """Size of the shadow maps of a renderer.

    Attributes:
        shadowSize: width of a map [px].
        shadowClip: half width of the map of a directional light [m].
    """

    shadowSize: int  # noqa: N815 - names of MuJoCo
    shadowClip: float  # noqa: N815


def read_lights(model: mujoco.MjModel) -> Lights:
    """Return the current poses and states of a model's lights."""
    return [getattr(model, field).copy() for field in _LIGHT_FIELDS]


@contextmanager
def use_lights(model: mujoco.MjModel, data: mujoco.MjData, lights: Lights) -> Iterator[None]:
    """Set saved lights in a model and its data, inside the `with` block."""
    current = read_lights(model)
    is_same = all(np.array_equal(*pair) for pair in zip(lights, current, strict=True))
    if not is_same:
        _write_lights(model, data, lights)
    try:
        yield
    finally:
        if not is_same:
            _write_lights(model, data, current)


def _write_lights(model: mujoco.MjModel, data: mujoco.MjData, lights: Lights) -> None:
    for field, values in zip(_LIGHT_FIELDS, lights, strict=True):
        getattr(model, field)[:] = values
    options = model.opt
    flags = options.enableflags
    # without sleep, `mj_camlight` also updates the lights of sleeping bodies
    options.enableflags = flags & ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    mujoco.mj_camlight(model, data)
    options.enableflags = flags


@contextmanager
def keep_strongest_lights(
    model: mujoco.MjModel, data: mujoco.MjData, position: Vector, rotation: Vector
) -> Iterator[None]:
    """Switch off the weakest lights inside the `with` block, if more lights are on than the engine can draw.

    Directional lights count as the strongest. All other lights are compared by their strength at the camera or 3 m
    ahead of the camera.
    """
    active = model.light_active
    shining = np.flatnonzero(active)
    if len(shining) <= MOST_LIGHTS:
        yield
        return
    strength = np.asarray(model.light_diffuse)[shining].max(axis=1).astype(np.float64)
    constant, linear, quadratic = np.asarray(model.light_attenuation)[shining].T
    positions, best = np.asarray(data.light_xpos)[shining], np.zeros(len(shining))
    for ahead in (0.0, _AHEAD):
        far = np.linalg.norm(positions - (position + ahead * rotation[:, 0]), axis=1)
        share = 1.0 / np.maximum(constant + far * (linear + far * quadratic), 1e-6)
        best = np.maximum(best, np.where(far <= np.asarray(model.light_range)[shining], share, 1e-6 * share))
    suns = np.asarray(model.light_type)[shining] == _DIRECTIONAL
    order = np.argsort(-np.where(suns, 1e9 * strength, strength * best), kind="stable")
    with temporary_values(active, shining[order[MOST_LIGHTS:]], 0):
        yield


def convert_point_lights(scene: mujoco.MjvScene) -> None:
    """Convert MuJoCo's point lights, which its rasteriser ignores, into spot lights that shine in all directions."""
    for light in scene.lights[: scene.nlight]:
        if light.type == mujoco.mjtLightType.mjLIGHT_POINT:
            light.type, light.cutoff, light.exponent = mujoco.mjtLightType.mjLIGHT_SPOT, 180.0, 0.0
            light.castshadow = 0


def suns_of(scene: mujoco.MjvScene) -> list[mujoco.MjvLight]:
    """Return the directional lights of a scene, without the headlight."""
    return [light for light in scene.lights[: scene.nlight] if light.type == _DIRECTIONAL and not light.headlight]


def place_directional_lights(
    scene: mujoco.MjvScene,
    context: ShadowSettings,
    model: mujoco.MjModel,
    position: Vector,
    forward: Vector,
    far: float,
    lit: Sphere | None = None,
) -> None:
    """Move directional lights so that their shadow maps cover the visible part of the scene.

    A map begins at the light's position and is as deep as the view. It covers a small scene as a whole. Of a larger
    scene, the map covers the part ahead of the camera. That part moves by whole pixels of the map, so that shadows do
    not flicker.

    Args:
        scene: scene whose lights are moved.
        context: size of the maps; their half width is written into it, as into MuJoCo's rendering context.
        model: compiled model.
        position: position of the camera in the world [m], shape (3,).
        forward: direction of the view, shape (3,).
        far: far clip plane [m].
        lit: sphere that the maps cover; None for the scene or the part ahead of the camera.
    """
    suns = [light for light in suns_of(scene) if light.castshadow]
    if not suns:
        return
    extent, middle = float(model.stat.extent), np.asarray(model.stat.center)
    reach = min(extent, _REACH, far / 2)
    is_whole = reach >= extent
    if lit is not None:
        middle, reach, is_whole = lit[0], min(lit[1], far / 2), True
    context.shadowClip = reach
    if not is_whole:
        middle = position + 0.8 * reach * forward
    back = min(far - reach, extent + reach)
    for light in suns:
        direction = np.asarray(light.dir, dtype=np.float64)
        centre = middle if is_whole else _snap_to_pixel_grid(middle, direction, 2.0 * reach / context.shadowSize)
        light.pos = centre - back * direction


def fit_shadow_maps(context: mujoco.MjrContext) -> None:
    """Correct where the engine reads a shadow map, because it draws the map inside a border of one pixel.

    The engine ignores that border when it reads the map. At the edge of the map, the error is a whole pixel, which is
    more than the engine's tolerance. Sunlit ground would then show dots of shadow.
    """
    from OpenGL import GL

    pixel = 1.0 / context.shadowSize
    inside = 1.0 - 2.0 * pixel
    columns = (inside, 0.0, 0.0, 0.0, 0.0, inside, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, pixel, pixel, 0.0, 1.0)
    GL.glActiveTexture(GL.GL_TEXTURE1)  # the engine uses this unit for shadows only
    GL.glMatrixMode(GL.GL_TEXTURE)
    GL.glLoadMatrixf(np.array(columns, dtype=np.float32))
    GL.glMatrixMode(GL.GL_MODELVIEW)
    GL.glActiveTexture(GL.GL_TEXTURE0)


def _snap_to_pixel_grid(position: Vector, direction: Vector, pixel: float) -> Vector:
    """Return a position rounded to a grid [m] that is fixed in the world and perpendicular to a direction."""
    side = np.cross(direction, (0.0, 0.0, 1.0) if abs(direction[2]) < 0.9 else (1.0, 0.0, 0.0))
    side /= norm(side)
    up = np.cross(direction, side)
    moved: Vector = position.copy()
    for axis in (side, up):
        offset = float(matmul(axis, position))
        moved += (round(offset / pixel) * pixel - offset) * axis
    return moved
