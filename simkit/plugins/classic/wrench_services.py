"""Wrenches and efforts with a duration: `/apply_link_wrench` and `/apply_joint_effort`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from simkit import msgs
from simkit.plugins.classic.property_services import joint_of
from simkit.plugins.world.service_entities import RequestRefused, find_entity, frame_of, require_finite, vector_of

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_WORLD = ("", "world", "map", "/map")


@dataclass(frozen=True, slots=True)
class TimedWrench:
    """Wrench on a link or effort on a joint, from one tick to another.

    Attributes:
        link: scoped name of the link; empty for an effort.
        joint: scoped name of the joint; empty for a wrench.
        values: force [N] and torque [N·m] in the world at the link's centre of mass, or the effort [N·m or N].
        start: first tick of the steps in which it acts.
        end: first tick after the steps in which it acts; None for no end.
    """

    link: str
    joint: str
    values: tuple[float, ...]
    start: int
    end: int | None


def link_wrench(
    sim: Simulation, link_name: str, request: msgs.ApplyLinkWrench_Request | msgs.ApplyBodyWrench_Request
) -> TimedWrench | None:
    """Return the wrench of a request; None for a duration of zero.

    The force acts at the reference point. If the reference frame is the world, the reference point is a vector from the
    link's centre of mass, as in Classic. If the reference frame is an entity, the reference point is a position in that
    entity's frame, by default its origin.

    Raises:
        RequestRefused: the link or the frame does not exist, or a number is NaN or infinite.
    """
    scoped = find_entity(sim, link_name, ("link",))[1]
    link = sim.link(scoped)
    force, torque = (np.array(vector_of(getattr(request.wrench, p), p)) for p in ("force", "torque"))
    point = np.array(vector_of(request.reference_point, "reference_point"))
    if request.reference_frame in _WORLD:
        lever = point
    else:
        frame = frame_of(sim, request.reference_frame)
        force, torque = frame.rotate(force), frame.rotate(torque)
        lever = frame.transform(point) - link.pose.transform(link.scene.inertial.com)
    span = _tick_range(sim, request)
    values = (*force.tolist(), *(torque + np.cross(lever, force)).tolist())
    return None if span is None else TimedWrench(scoped, "", values, *span)


def joint_effort(sim: Simulation, request: msgs.ApplyJointEffort_Request) -> TimedWrench | None:
    """Return the effort of a request; None for a duration of zero.

    Raises:
        RequestRefused: the joint does not exist or does not have exactly one degree of freedom, or the effort is NaN or
            infinite.
    """
    joint = joint_of(sim, request.joint_name)
    if joint.dof != 1:
        raise RequestRefused(f"joint {joint.scoped!r} has {joint.dof} degrees of freedom; expected one")
    effort, span = require_finite(request.effort, "effort"), _tick_range(sim, request)
    return None if span is None else TimedWrench("", joint.scoped, (effort,), *span)


def _tick_range(
    sim: Simulation,
    request: msgs.ApplyLinkWrench_Request | msgs.ApplyBodyWrench_Request | msgs.ApplyJointEffort_Request,
) -> tuple[int, int | None] | None:
    """Return the first tick and the end tick.

    The end tick is None for a negative duration. The result is None for a duration of zero.
    """
    duration, start_ns = msgs.stamp_ns(request.duration), msgs.stamp_ns(request.start_time)
    start = sim.tick
    if start_ns > sim.time_ns:
        start = sim.engine.clock.ticks(start_ns / 1e9)
        while sim.engine.clock.time_ns(start) < start_ns:
            start += 1
    if duration < 0:
        return start, None
    step_ns = sim.engine.clock.time_ns(1)
    return (start, start + math.ceil(duration / step_ns)) if duration else None


def apply_wrenches(sim: Simulation, pushes: list[TimedWrench]) -> list[TimedWrench]:
    """Apply the active wrenches for the next step; return those that have not ended and whose entity still exists."""
    tick = sim.tick
    tables = sim.contents.handles.tables
    left = [
        p
        for p in pushes
        if (p.end is None or tick < p.end) and (p.link in tables["link"] or p.joint in tables["joint"])
    ]
    for push in left:
        if tick < push.start:
            continue
        if push.link:
            sim.link(push.link).apply_wrench(push.values[:3], push.values[3:])
        else:
            joint = sim.joint(push.joint)
            waiting = float(sim.mj_data.qfrc_applied[joint.mj_dofs[0]]) if sim.engine.physics.one_shot else 0.0
            joint.set_effort(waiting + push.values[0])
    return left
