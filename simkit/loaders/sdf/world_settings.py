"""Readers of a world's settings: physics, gravity, scene, atmosphere, spherical coordinates."""

from __future__ import annotations

import math

from simkit.diagnostics import did_you_mean
from simkit.loaders.sdf.material import read_colour
from simkit.params import Params
from simkit.run_spec import RENDERERS
from simkit.scene import Atmosphere, Physics, SphericalCoordinates, Surroundings
from simkit.scene.geometry import Vec3
from simkit.scene.world import CONTACT_LAWS, QUALITIES, Fog

_GRAVITY: Vec3 = (0.0, 0.0, -9.8)
_SHORTEST = 1e-9  # shortest step [s]
_LONGEST = 100.0  # longest step [s]; larger numbers are mistakes


def read_physics(world: Params) -> tuple[Physics, Vec3]:
    """Return the default physics profile, and gravity [m/s²] from the world or (before SDF 1.6) from that profile."""
    profiles = world.all("physics")
    chosen = next((p for p in profiles if p.attribute("default", "false").lower() in ("true", "1")), None)
    if chosen is None and profiles:
        chosen = profiles[0]
    for profile in profiles:
        name = profile.attribute("name")
        if profile is not chosen:
            profile.mark_all_read()
            profile.note("SK-SDF-023", f"physics profile {name!r} is not the default and is ignored")
    block = chosen or Params("physics", where=world.where, diagnostics=world.diagnostics)
    inside = block.vector3("gravity", _GRAVITY)
    gravity = world.vector3("gravity", inside)
    step = block.number("max_step_size", _old_step(block), maximum=_LONGEST)
    if step < _SHORTEST:
        allowed = "a positive number" if step <= 0 else f"at least {_SHORTEST:g} s, because time is in nanoseconds"
        block.error("SK-PARAM-002", f"found <max_step_size>{step:g}</max_step_size>; expected {allowed}")
        step = 0.001
    law = block.choice("contact_law", CONTACT_LAWS, "simkit")
    factor = max(0.0, _real_time_factor(block, step))
    is_bullet = block.attribute("type") == "bullet" or _names_bullet(world)
    return Physics(
        step, factor, block.where, _contacts(block), contact_law=law, engine="bullet" if is_bullet else None
    ), gravity


def _names_bullet(world: Params) -> bool:
    """Check whether a Physics system names one of gz's libraries of Bullet in `<engine><filename>`."""
    plugins = (child for child in world.children if child.name == "plugin")
    engines = (child for plugin in plugins for child in plugin.children if child.name == "engine")
    return any("bullet" in file.value for engine in engines for file in engine.children if file.name == "filename")


def _contacts(block: Params) -> int:
    """Return the maximum number of contacts of one pair of collisions; by default and for -1 it is 20, as in Gazebo."""
    count = block.integer("max_contacts", 20, minimum=-1)
    return 20 if count < 0 else count


def _real_time_factor(block: Params, step: float) -> float:
    """Return the real-time factor; if the file gives only an update rate, the factor is update rate times step."""
    rate = block.number("real_time_update_rate", block.number("update_rate", 0.0, minimum=0.0), minimum=0.0)
    has_rate = block.has("real_time_update_rate") or block.has("update_rate")
    return block.number("real_time_factor", rate * step if has_rate else 1.0)


def _old_step(block: Params) -> float:
    """Return the step [s] from `<dt>`, the spelling before SDF 1.4."""
    for engine in block.children:
        for holder in (engine, *engine.children):
            if engine.name in ("ode", "bullet") and any(c.name == "dt" for c in holder.children):
                return holder.number("dt", 0.001)
    return 0.001


# Semi-axes [m] of the named surfaces: WGS84 (NIMA TR8350.2) and the Moon's mean sphere.
SURFACES = {"EARTH_WGS84": (6378137.0, 6356752.314245), "MOON_SCS": (1737400.0, 1737400.0), "CUSTOM_SURFACE": None}

_FOGS = ("linear", "exp", "exp2")
_FOG_HINT = "the format's own types constant and quadratic have no effect in Gazebo Classic either"


def read_surroundings(world: Params) -> Surroundings:
    """Return colours, shadows, sky and fog of the `<scene>`."""
    scene = world.block("scene")
    return Surroundings(
        ambient=read_colour(scene, "ambient", (0.4, 0.4, 0.4, 1.0)),
        background=read_colour(scene, "background", (0.7, 0.7, 0.7, 1.0)),
        shadows=scene.boolean("shadows", True),
        grid=scene.boolean("grid", True),
        sky=scene.child("sky") is not None,
        fog=_fog(scene),
    )


def _fog(scene: Params) -> Fog | None:
    """Return `<fog>` as Gazebo Classic draws it: its three types have other names than those in the format."""
    block = scene.child("fog")
    if block is None:
        return None
    kind = block.text("type", "none")
    fog = Fog(
        type=kind,
        colour=read_colour(block, "color", (1.0, 1.0, 1.0, 1.0)),
        start=block.number("start", 1.0, minimum=0.0),
        end=block.number("end", 100.0, minimum=0.0),
        density=block.number("density", 1.0, minimum=0.0),
    )
    if kind == "none":
        return None
    if kind not in _FOGS:
        message = f"found <type>{kind}</type> of a fog; expected one of none, {', '.join(_FOGS)}; no fog is drawn"
        block.child_or_self("type").warning("SK-RENDER-010", message, did_you_mean(kind, _FOGS) or _FOG_HINT)
        return None
    return fog


def read_quality(world: Params) -> str:
    """Return `<quality>` of the scene, simkit's own element: fast, gazebo or high."""
    return world.block("scene").choice("quality", QUALITIES, "fast")


def read_renderer(world: Params) -> str:
    """Return `<renderer>` of the scene or of the world, simkit's own element: auto, gl or software."""
    of_world = world.choice("renderer", RENDERERS, "auto")
    return world.block("scene").choice("renderer", RENDERERS, of_world)


def read_atmosphere(world: Params) -> Atmosphere:
    """Return the air at the origin; the format has only the adiabatic kind."""
    block = world.block("atmosphere")
    kind = block.attribute("type", "adiabatic") or "adiabatic"
    if kind != "adiabatic":
        message = f"<atmosphere type={kind!r}>: unknown type; the only type is adiabatic"
        block.error("SK-SDF-036", message, did_you_mean(kind, ("adiabatic",)))
    return Atmosphere(
        temperature=block.number("temperature", 288.15, minimum=0.0),
        temperature_gradient=block.number("temperature_gradient", -0.0065),
        pressure=block.number("pressure", 101325.0, minimum=0.0),
        where=block.where,
    )


def read_spherical_coordinates(world: Params) -> SphericalCoordinates | None:
    """Return the position of the origin on a planet; angles are degrees in the file."""
    block = world.child("spherical_coordinates")
    if block is None:
        return None
    orientation = block.text("world_frame_orientation", "ENU")
    if orientation != "ENU":
        message = f"<world_frame_orientation> {orientation!r} is not supported; ENU is used"
        block.child_or_self("world_frame_orientation").warning("SK-SDF-012", message)
    equatorial, polar = _surface(block)
    return SphericalCoordinates(
        latitude=math.radians(block.number("latitude_deg", 0.0, minimum=-90, maximum=90)),
        longitude=math.radians(block.number("longitude_deg", 0.0, minimum=-360, maximum=360)),
        elevation=block.number("elevation", 0.0, minimum=-1e9, maximum=1e9),
        heading=math.radians(block.number("heading_deg", 0.0, minimum=-1e6, maximum=1e6)),
        where=block.where,
        surface=block.text("surface_model", "EARTH_WGS84"),
        equatorial=equatorial,
        polar=polar,
    )


def _surface(block: Params) -> tuple[float, float]:
    """Return the semi-axes [m] of the surface; a custom surface gives its own."""
    name = block.text("surface_model", "EARTH_WGS84")
    custom = name == "CUSTOM_SURFACE"
    axes = tuple(block.number(f"surface_axis_{a}", 0.0, required=custom) for a in ("equatorial", "polar"))
    place = block.child_or_self("surface_model")
    if name not in SURFACES:
        message = f"<surface_model> {name!r} is not one of {', '.join(SURFACES)}"
        place.error("SK-SDF-036", message, did_you_mean(name, SURFACES))
    if not custom:
        return SURFACES.get(name) or SURFACES["EARTH_WGS84"] or (0.0, 0.0)
    if min(axes) <= 0:
        message = f"CUSTOM_SURFACE has the semi-axes {axes[0]:g} and {axes[1]:g} m; both must be positive"
        place.error("SK-SDF-036", message)
    return axes[0], axes[1]
