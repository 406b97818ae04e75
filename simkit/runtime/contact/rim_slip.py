"""Slip of wheels: the speed of the rim minus the speed of the axle over the ground.

The slip is ground truth from the contacts. Odometry from wheels that do not slip is wrong only if it assumes another
radius or separation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.float_sum import float_sum
from simkit.linear_algebra import dot, matmul, norm
from simkit.runtime.contact.collision_contacts import (
    CollisionContacts,
    collision_table,
    find_contacts,
    point_velocity,
    slip_velocities,
)
from simkit.runtime.contact.wheel_contacts import WHEEL_SHAPES, turns_freely, wheel_column

if TYPE_CHECKING:
    from simkit.compiler import Compiled
    from simkit.compiler.name_map import NameMap
    from simkit.pose import Vector

LEAST_SPEED: Final = 1e-3
"""Speed of rim and axle [m/s] below which a wheel counts as stopped: its ratio is then 0."""

_TREAD: Final = math.cos(math.radians(45.0))
"""Largest cosine between the axle and the normal of a contact of the tread; other contacts are those of its side."""


@dataclass(frozen=True, slots=True)
class WheelSlip:
    """Motion of a wheel over the ground that it touches. For a wheel that touches nothing, all speeds are NaN.

    Attributes:
        joint: scoped name of the joint of the wheel.
        collision: scoped name of the collision of the wheel.
        ground: scoped name of the collision that the wheel touches; empty for none. Of several, the one with the
            largest load.
        load: sum of the normal forces [N].
        radius: distance from the axle to the contact [m].
        rim_speed: speed at which the tread passes the axle [m/s]; positive if the joint turns in its positive
            direction.
        axle_speed: speed of the axle over the ground in the direction in which the wheel rolls [m/s].
        slip: `rim_speed - axle_speed` [m/s]: the speed of the tread over the ground.
        ratio: `slip` divided by the faster of both speeds: 0 for a wheel that rolls, 1 for one that spins on the spot,
            -1 for a blocked one that is dragged. 0 if both are below 1 mm/s.
        sideways: speed over the ground along the axis of the joint [m/s].
    """

    joint: str
    collision: str
    ground: str = ""
    load: float = 0.0
    radius: float = math.nan
    rim_speed: float = math.nan
    axle_speed: float = math.nan
    slip: float = math.nan
    ratio: float = math.nan
    sideways: float = math.nan


def list_wheel_slips(compiled: Compiled, data: mujoco.MjData, model: str | None) -> list[WheelSlip]:
    """Return the slip of all wheels, in the order of the engine's joints.

    Wheels are round collisions that turn freely about their own axis. A wheel that touches nothing is listed if its
    axis is less than 45° from the horizontal, as that of a propeller is not.

    Args:
        compiled: compiled model.
        data: MuJoCo's data with a complete forward pass.
        model: scoped name of a model; only its wheels are listed. None for all wheels.
    """
    wheels = compiled.names.shared("wheels", lambda: _find_wheels(compiled.model, compiled.names))
    wheels = {joint: wheel for joint, wheel in wheels.items() if model is None or wheel[0].startswith(f"{model}::")}
    if not wheels:
        return []
    selected = np.zeros(compiled.model.ngeom + 1, bool)
    selected[[geom for _, geoms in wheels.values() for geom in geoms]] = True
    contacts = find_contacts(compiled.model, data, selected)
    velocities = None if contacts is None else slip_velocities(compiled.model, data, contacts)
    slips = (_wheel_slip(compiled, data, joint, *wheel, contacts, velocities) for joint, wheel in wheels.items())
    return [slip for slip in slips if slip is not None]


def _find_wheels(model: mujoco.MjModel, names: NameMap) -> dict[int, tuple[str, list[int]]]:
    """Return the scoped name of the joint and the geoms of each wheel, by MuJoCo's joint."""
    scoped = {number: name for name, binding in names.joints.items() for number in binding.joint_ids}
    wheels: dict[int, tuple[str, list[int]]] = {}
    for joint in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE).tolist():
        if joint in scoped and turns_freely(model, joint):
            body = model.jnt_bodyid[joint]
            geoms = np.flatnonzero(model.geom_bodyid == body).tolist()
            round_geoms = [geom for geom in geoms if wheel_column(model, geom, joint, WHEEL_SHAPES) is not None]
            if round_geoms:
                wheels[joint] = (scoped[joint], round_geoms)
    return wheels


def _wheel_slip(
    compiled: Compiled,
    data: mujoco.MjData,
    joint: int,
    name: str,
    geoms: list[int],
    contacts: CollisionContacts | None,
    velocities: Vector | None,
) -> WheelSlip | None:
    """Return the slip of a wheel, the mean over its contacts by load; None for an axis that is no axle."""
    axis, model, table = data.xaxis[joint], compiled.model, collision_table(compiled)
    tread = table.names[table.of_geom[geoms[0]]]
    loads: list[float] = []
    found: list[tuple[float, float, float, float]] = []  # radius, rim speed, slip, speed sideways
    load_by_ground: dict[str, float] = {}
    for place, pair in enumerate([] if contacts is None else contacts.geoms.tolist()):
        assert contacts is not None and velocities is not None
        load = float(contacts.wrenches[place, 0])
        if load <= 0.0 or not {*pair} & {*geoms} or abs(dot(axis, contacts.frames[place, 0])) > _TREAD:
            continue
        towards_wheel = 1.0 if pair[1] in geoms else -1.0
        up, point = towards_wheel * contacts.frames[place, 0], contacts.positions[place]
        ahead = np.cross(axis, up) / norm(np.cross(axis, up))
        over_ground = towards_wheel * matmul(velocities[place], contacts.frames[place])
        arm = point - data.xanchor[joint]
        arm -= dot(arm, axis) * axis
        rim, axle = (point_velocity(model, data, geoms[0], place) for place in (point, point - arm))
        ground = table.names[table.of_geom[pair[0 if pair[1] in geoms else 1]]]
        load_by_ground[ground] = load_by_ground.get(ground, 0.0) + load
        loads.append(load)
        found.append((norm(arm), dot(axle - rim, ahead), -dot(over_ground, ahead), dot(over_ground, axis)))
    if not found:
        gravity = model.opt.gravity
        is_axle = abs(dot(axis, gravity)) < _TREAD * norm(gravity)
        return WheelSlip(name, tread) if is_axle else None
    total = float_sum(loads)
    radius, rim_speed, slip, sideways = (
        float_sum(load * value for load, value in zip(loads, column, strict=True)) / total
        for column in zip(*found, strict=True)
    )
    axle_speed = rim_speed - slip
    faster = max(rim_speed, axle_speed, key=abs)
    ratio = slip / faster if abs(faster) >= LEAST_SPEED else 0.0
    main = max(load_by_ground, key=load_by_ground.__getitem__)
    return WheelSlip(name, tread, main, total, radius, rim_speed, axle_speed, slip, ratio, sideways)
