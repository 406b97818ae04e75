"""Settings of a world for services: physics, and the location on Earth of the world or of an entity."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from simkit.linear_algebra import matmul
from simkit.plugins.world.service_entities import RequestRefused, require_finite, vector_fields, vector_of
from simkit.pose import Pose, quat_from_rpy
from simkit.scene import SphericalCoordinates
from simkit.sensors.environment.geodesy import WorldOnPlanet

if TYPE_CHECKING:
    from simkit.msgs import SetPhysicsProperties_Request, SetSphericalCoordinates_Request
    from simkit.runtime import Light, Model, Simulation

_SAME: Final = 1e-9  # relative tolerance of step sizes
_OF_ODE: Final = (
    "auto_disable_bodies",
    "sor_pgs_precon_iters",
    "sor_pgs_iters",
    "sor_pgs_w",
    "sor_pgs_rms_error_tol",
    "contact_surface_layer",
    "contact_max_correcting_vel",
    "cfm",
    "erp",
    "max_contacts",
)


def set_physics(sim: Simulation, request: SetPhysicsProperties_Request, *, keeps_gravity: bool = False) -> str:
    """Change gravity and the real-time pace; a different step length is refused without any change.

    Args:
        sim: simulation.
        request: a `gazebo_msgs/srv/SetPhysicsProperties_Request`.
        keeps_gravity: True to ignore the gravity in the request.

    Returns:
        Message that lists the unsupported settings of the request; empty if all are supported.

    Raises:
        RequestRefused: the step differs from the world's, or a number is NaN, infinite or out of range.
    """
    step, rate = (
        require_finite(request.time_step, "time_step", 0.0),
        require_finite(request.max_update_rate, "max_update_rate"),
    )
    gravity = vector_of(request.gravity, "gravity")
    if step and abs(step - sim.timestep) > _SAME * sim.timestep:
        raise RequestRefused(
            f"found time_step {step:g}, it is {sim.timestep:g} and cannot change while a world runs: servos, contacts "
            "and the times of all samples are made for it; load the world with --set physics.max_step_size=... "
            "(overrides=)"
        )
    if not keeps_gravity:
        sim.gravity = gravity
    sim.control.pausing.pace = rate * sim.timestep if rate > 0.0 else None
    current = _config_fields(sim)
    requested = {name: getattr(request.ode_config, name) for name in current}
    changed = [name for name, value in requested.items() if value and value != current[name]]
    return f"not supported by this physics engine: {', '.join(changed)}" if changed else ""


def _config_fields(sim: Simulation) -> dict[str, float]:
    """Return the fields of an `ODEPhysics` message; settings without a counterpart are zero."""
    return {
        **dict.fromkeys(_OF_ODE, 0),
        "auto_disable_bodies": bool(sim.engine.physics.sleep.enabled),
        "sor_pgs_iters": int(sim.mj_model.opt.iterations),
        "sor_pgs_rms_error_tol": float(sim.mj_model.opt.tolerance),
        "max_contacts": int(sim.world.physics.max_contacts),
    }


def physics_fields(sim: Simulation) -> dict[str, object]:
    """Return the fields of a `gazebo_msgs/srv/GetPhysicsProperties_Response`."""
    pace = sim.control.pausing.pace or 0.0  # no pace means as fast as possible, which is a rate of 0 in Gazebo
    return {
        "time_step": sim.timestep,
        "pause": sim.paused,
        "max_update_rate": pace / sim.timestep,
        "gravity": vector_fields(sim.gravity),
        "ode_config": _config_fields(sim),
        "status_message": "GetPhysicsProperties: got properties",
    }


_MOON: Final = 1737400.0, 1737400.0  # semi-axes of the moon [m], as for `<surface_model>MOON_SCS</surface_model>`
_EARTH: Final = 6378137.0, 6356752.314245  # of WGS 84


def set_world_location(sim: Simulation, request: SetSphericalCoordinates_Request) -> None:
    """Move the world's origin, which sensors of position and magnetic field then use; raises `RequestRefused`."""
    latitude, longitude, elevation, heading = _numbers(request)
    surface = int(request.surface_model)
    if surface not in (0, 1):
        raise RequestRefused(f"found surface_model {surface}; expected 0 (EARTH_WGS84) or 1 (MOON_SCS)")
    name, (equatorial, polar) = ("EARTH_WGS84", _EARTH) if surface == 0 else ("MOON_SCS", _MOON)
    before = sim.control.origin.place or SphericalCoordinates(where=sim.world.where)
    sim.control.origin.move(
        replace(
            before,
            latitude=latitude,
            longitude=longitude,
            elevation=elevation,
            heading=heading,
            surface=name,
            equatorial=equatorial,
            polar=polar,
        )
    )


def set_entity_location(sim: Simulation, handle: Model | Light, request: SetSphericalCoordinates_Request) -> None:
    """Move a model or a light to a geographic location, upright and rotated by the heading about z.

    Raises:
        RequestRefused: the world has no spherical coordinates, or a number is invalid.
    """
    if sim.control.origin.place is None:
        raise RequestRefused("the world has no <spherical_coordinates>, which are needed to place an entity")
    latitude, longitude, elevation, heading = _numbers(request)
    planet = WorldOnPlanet(sim.control.origin.place)
    position = matmul(planet.axes.T, planet.ellipsoid.cartesian(latitude, longitude, elevation) - planet.origin)
    handle.set_pose(Pose(position, quat_from_rpy(0.0, 0.0, heading)))


def _numbers(request: SetSphericalCoordinates_Request) -> tuple[float, float, float, float]:
    """Return latitude, longitude [rad], elevation [m] and heading [rad]."""
    latitude = require_finite(request.latitude_deg, "latitude_deg")
    longitude = require_finite(request.longitude_deg, "longitude_deg")
    if not -90.0 <= latitude <= 90.0:
        raise RequestRefused(f"found latitude_deg {latitude:g}; expected a number from -90 to 90")
    elevation, heading = (
        require_finite(request.elevation, "elevation"),
        require_finite(request.heading_deg, "heading_deg"),
    )
    return math.radians(latitude), math.radians(longitude), elevation, math.radians(heading)
