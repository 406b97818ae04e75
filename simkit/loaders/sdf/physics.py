"""What surrounds the models of a world: `<physics>`, gravity, `<scene>`, and the place on Earth."""

from __future__ import annotations

import math

from simkit.diagnostics import Diagnostics
from simkit.loaders.sdf.material import read_colour
from simkit.params import Params
from simkit.scene import Physics, SphericalCoordinates, Surroundings
from simkit.scene.geometry import Vec3

_GRAVITY: Vec3 = (0.0, 0.0, -9.8)


def read_physics(world: Params, diagnostics: Diagnostics) -> tuple[Physics, Vec3]:
    """The default physics profile, and gravity [m/s²] from the world or (before 1.6) from that profile."""
    profiles = world.all("physics")
    chosen = next((p for p in profiles if p.attribute("default", "false").lower() in ("true", "1")), None)
    if chosen is None and profiles:
        chosen = profiles[0]
    for other in profiles:
        if other is not chosen:
            other.mark_all_read()
            diagnostics.note(
                "SK-SDF-023",
                f"physics profile {other.attribute('name')!r} is not the default and not used",
                other.where,
            )
    block = chosen or Params("physics", where=world.where, diagnostics=diagnostics)
    inside = block.vector3("gravity", _GRAVITY)
    gravity = world.vector3("gravity", inside)
    step = block.number("max_step_size", _old_step(block))
    if step <= 0:
        diagnostics.error(
            "SK-PARAM-002", f"found <max_step_size>{step:g}</max_step_size>, it must be positive", block.where
        )
        step = 0.001
    factor = block.number("real_time_factor", 1.0)
    return Physics(step, max(0.0, factor), block.where), gravity


def _old_step(block: Params) -> float:
    """The step as it was written before 1.4."""
    for engine in block.children:
        for holder in (engine, *engine.children):
            if engine.name in ("ode", "bullet") and any(c.name == "dt" for c in holder.children):
                return holder.number("dt", 0.001)
    return 0.001


def read_surroundings(world: Params) -> Surroundings:
    """Colours and shadows of the `<scene>`."""
    scene = world.block("scene")
    return Surroundings(
        ambient=read_colour(scene, "ambient", (0.4, 0.4, 0.4, 1.0)),
        background=read_colour(scene, "background", (0.7, 0.7, 0.7, 1.0)),
        shadows=scene.boolean("shadows", True),
        grid=scene.boolean("grid", True),
        sky=scene.has("sky"),
    )


def read_quality(world: Params) -> str:
    """`<simkit:quality>` of the scene: fast, gazebo or high."""
    return world.block("scene").choice("simkit:quality", ("fast", "gazebo", "high"), "fast")


def read_spherical_coordinates(world: Params, diagnostics: Diagnostics) -> SphericalCoordinates | None:
    """Where on Earth the origin lies; angles are degrees in the file."""
    block = world.child("spherical_coordinates")
    if block is None:
        return None
    orientation = block.text("world_frame_orientation", "ENU")
    surface = block.text("surface_model", "EARTH_WGS84")
    if orientation != "ENU" or surface != "EARTH_WGS84":
        diagnostics.warning(
            "SK-SDF-012",
            f"<spherical_coordinates> {surface}, {orientation}: only EARTH_WGS84 and ENU are simulated",
            block.where,
        )
    return SphericalCoordinates(
        latitude=math.radians(block.number("latitude_deg", 0.0, minimum=-90, maximum=90)),
        longitude=math.radians(block.number("longitude_deg", 0.0)),
        elevation=block.number("elevation", 0.0),
        heading=math.radians(block.number("heading_deg", 0.0)),
        where=block.where,
    )
