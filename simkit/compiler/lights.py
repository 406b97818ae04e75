"""Lights of the file as MuJoCo's lights."""

from __future__ import annotations

import math
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.diagnostics import Diagnostics, Where
from simkit.linear_algebra import norm
from simkit.pose import IDENTITY, Pose
from simkit.scene import SceneLight, SceneWorld

FARTHEST: Final = 100.0
"""Largest distance [m] from which directional lights are drawn: their position only frames the shadow map."""

MOST_LIGHTS: Final = 7
"""Largest number of lights in an image, without the ambient light. OpenGL has eight lights in total."""

_MOST_LEFT: Final = 0.1  # fraction of the light that is left at the range; with SDF's defaults 9 % are left
_FARTHEST_LAMP: Final = 1e4
_MOST_FADING: Final = 1e9  # largest range [m] and attenuation; the engine stores them in single precision
_EVERYWHERE: Final = 180.0  # [degrees] cutoff at which OpenGL's spot is a point light
_FINEST, _COARSEST, _SQUARES = 0.1, 1.0, 200  # squares of a plane: least and largest size [m], number along an edge
_MOST_QUADS: Final = 20_000  # largest number in all boxes together
_LEAST_SLICES, _MOST_SLICES = 4, 16  # divisions of an edge of a box; the renderer's default is 4
_DRAWN_FIELDS: Final = ("diffuse", "specular", "attenuation", "range", "cutoff", "exponent", "castshadow")
_SPOT: Final = (math.radians(30.0), math.radians(40.0))  # [rad] inner and outer angle of the renderers' default cone


def drawn_position(light: SceneLight, position: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return the position from which MuJoCo draws a light: a distant light is moved towards the origin.

    Some worlds have a sun at 256e9 m, which overflows the renderer's matrices.
    """
    place = np.asarray(position, float)
    most = FARTHEST if light.type == "directional" else _FARTHEST_LAMP
    length = norm(place)
    return place * (most / length) if length > most else place


def add_light(body: mujoco.MjsBody, light: SceneLight, pose: Pose, shadows: bool) -> None:
    """Add a light at `pose` in the frame of `body`."""
    write_light(body.add_light(name=light.scoped), light, pose, shadows)


def write_light(made: mujoco.MjsLight, light: SceneLight, pose: Pose, shadows: bool) -> None:
    """Write all properties of a light at `pose` in the frame of its body."""
    kinds = mujoco.mjtLightType
    # the renderer has no point lights: a spot with a cutoff of 180° replaces one
    made.type = kinds.mjLIGHT_DIRECTIONAL if light.type == "directional" else kinds.mjLIGHT_SPOT
    made.pos = drawn_position(light, pose.position)
    made.dir = pose.rotate(light.direction)
    made.active = light.on
    # the renderer's shadow map covers one cone only; most of a point light would be missing
    made.castshadow = bool(shadows and light.cast_shadows and light.type != "point")
    made.ambient = (0.0, 0.0, 0.0)
    made.diffuse = np.clip(np.asarray(light.diffuse[:3]) * light.intensity, 0.0, 10.0)
    made.specular = np.clip(np.asarray(light.specular[:3]) * light.intensity, 0.0, 10.0)
    if light.type != "directional":
        reach, *parts = light.attenuation
        made.range = min(max(reach, 1e-3), _MOST_FADING)
        constant, linear, quadratic = (min(max(part, -_MOST_FADING), _MOST_FADING) for part in parts)
        made.attenuation = (constant, linear, quadratic) if constant + linear + quadratic > 0.0 else (1.0, 0.0, 0.0)
        made.cutoff = _EVERYWHERE
    if light.type == "spot":
        made.cutoff, made.exponent = spot_parameters(light)


def drawn_fields(light: SceneLight, shadows: bool) -> dict[str, npt.NDArray[np.float64]]:
    """Return the fields of MuJoCo's light without its position, its direction and its on/off state."""
    spec = mujoco.MjSpec()
    add_light(spec.worldbody, light, IDENTITY, shadows)
    drawn = spec.worldbody.lights[0]
    return {field: np.array(getattr(drawn, field)) for field in _DRAWN_FIELDS}


def report_light(light: SceneLight, world: SceneWorld, diagnostics: Diagnostics) -> None:
    """Report the properties of a light that images do not show: the end of its range, and shadows of a point light."""
    if light.type == "directional":
        return
    reach, constant, linear, quadratic = light.attenuation
    left = 1.0 / max(constant + reach * (linear + reach * quadratic), 1e-9) if math.isfinite(reach) else 0.0
    if left > _MOST_LEFT:
        message = (
            f"light {light.scoped!r} still has {100.0 * min(left, 1.0):.0f} % of its brightness at its range of "
            f"{reach:g} m; images show the light beyond its range"
        )
        hint = "raise <linear> or <quadratic>, so that the light fades within its range"
        diagnostics.note("SK-RENDER-013", message, light.where, hint)
    if light.type == "point" and light.cast_shadows and world.surroundings.shadows and world.quality != "fast":
        message = f"the point light {light.scoped!r} casts no shadows; only directional lights and spots do"
        diagnostics.note("SK-RENDER-014", message, light.where)


def report_lights(model: mujoco.MjModel, diagnostics: Diagnostics, where: Where) -> None:
    """Report a world with more lights than an image can have."""
    shining = int(np.count_nonzero(model.light_active))
    if shining > MOST_LIGHTS:
        message = (
            f"{shining} lights are on; an image shows only {MOST_LIGHTS}: directional lights first, "
            "then the lights that are brightest for its camera"
        )
        diagnostics.note("SK-RENDER-012", message, where)


def spot_parameters(light: SceneLight) -> tuple[float, float]:
    """Return cutoff [degrees, half of the cone] and exponent of a spot.

    In Gazebo, the light falls from 1 at half the inner angle to 0 at half the outer angle, as a straight line to the
    power of `falloff`. In OpenGL, the light is the cosine to the power of `exponent`. Both are equal half-way between
    the two angles.
    """
    inner, outer, falloff = _cone(light)
    cutoff = min(90.0, max(1.0, math.degrees(outer) / 2))
    middle = (inner + outer) / 4
    share = math.cos(min(middle, math.radians(89.0)))
    exponent = falloff * math.log(0.5) / math.log(share) if share < 1.0 - 1e-9 else 0.0
    return cutoff, min(128.0, max(0.0, exponent))


def spot_share(light: SceneLight, angle: float) -> float:
    """Return the fraction of a spot's light at an angle [rad] from its axis, as in Gazebo.

    The fraction is 1 within half the inner angle and 0 beyond half the outer one. Between these angles the fraction is
    a straight line to the power of `falloff`.
    """
    inner, outer, falloff = _cone(light)
    if angle <= inner / 2:
        return 1.0
    if angle >= outer / 2:
        return 0.0
    return float(((outer / 2 - angle) / (outer / 2 - inner / 2)) ** max(0.0, falloff))


def _cone(light: SceneLight) -> tuple[float, float, float]:
    """Return the inner angle [rad], the larger outer angle [rad] and the falloff of a spot."""
    inner, outer, falloff = light.spot
    if outer <= 0.0:
        inner, outer = _SPOT
    return min(max(inner, 0.0), outer), outer, falloff


def refine_for_lamps(model: mujoco.MjModel) -> None:
    """Divide planes and boxes more finely in worlds with point lights or spots.

    The renderer computes the light at the corners of squares and interpolates between them. With squares of 1 m, a spot
    that lights only the middle of a square would be invisible.
    """
    lamps = np.asarray(model.light_type) != int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
    if not lamps.any():
        return
    planes = np.flatnonzero(model.geom_type == int(mujoco.mjtGeom.mjGEOM_PLANE))
    longest = 2.0 * model.geom_size[planes, :2].max(axis=1)
    model.geom_size[planes, 2] = np.clip(longest / _SQUARES, _FINEST, _COARSEST)
    boxes = max(1, int(np.count_nonzero(model.geom_type == int(mujoco.mjtGeom.mjGEOM_BOX))))
    slices = int(math.sqrt(_MOST_QUADS / (6 * boxes)))
    model.vis.quality.numquads = min(_MOST_SLICES, max(_LEAST_SLICES, slices))
