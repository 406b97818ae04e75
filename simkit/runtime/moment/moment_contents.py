"""Contacts, joints and constraints of a simulation at one time, in numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.runtime.contact.rim_slip import LEAST_SPEED, WheelSlip

AT_LIMIT: Final = 0.98
"""Least share of a friction limit at which the limit counts as reached."""

SATURATED: Final = 0.999
"""Least share of an effort or velocity limit at which the limit counts as reached."""

Numbers = tuple[float, ...]
"""One number for each degree of freedom of a joint."""


@dataclass(frozen=True, slots=True)
class TouchingPair:
    """Two collisions that touch.

    Attributes:
        first, second: scoped names of the collisions, the one of a static model last.
        points: number of contact points.
        depth: largest penetration [m].
        normal_force: sum of the normal forces [N].
        friction_force: friction force of the pair [N].
        friction_limit: sum of friction coefficient times normal force [N].
        friction_use: share of the friction limit that the points use, 0 to 1; 0 without friction.
        slip_speed: fastest speed of a loaded point of one surface over the other [m/s].
    """

    first: str
    second: str
    points: int
    depth: float
    normal_force: float
    friction_force: float
    friction_limit: float
    friction_use: float
    slip_speed: float

    @property
    def is_at_limit(self) -> bool:
        """True if the friction has its limit."""
        return self.friction_use >= AT_LIMIT

    @property
    def slides(self) -> bool:
        """True if the friction has its limit and the surfaces move over each other."""
        return self.is_at_limit and self.slip_speed >= LEAST_SPEED


@dataclass(frozen=True, slots=True)
class JointLoad:
    """Motion and effort of a joint; angles in rad, lengths in m, efforts in N·m or N.

    Attributes:
        joint: scoped name.
        type: joint type in the file.
        position, velocity, effort: as of the handle `sim.joint(name)`.
        steady_effort: effort that would keep the velocity of each degree of freedom under the present contacts. A joint
            with a smaller effort gives way.
        effort_limit: effort limit of the joint and its actuators, for each axis; infinite for none.
        saturated: True if an axis has the effort limit.
        velocity_limit: least velocity limit of the axes; infinite for none.
        stop: "lower", "upper" or "limit" while a position limit stops the joint, else empty.
        stop_effort: effort of this limit.
    """

    joint: str
    type: str
    position: Numbers
    velocity: Numbers
    effort: Numbers
    steady_effort: Numbers
    effort_limit: Numbers
    saturated: bool
    velocity_limit: float
    stop: str = ""
    stop_effort: float = 0.0

    @property
    def is_at_velocity_limit(self) -> bool:
        """True if an axis has the velocity limit."""
        return max(map(abs, self.velocity), default=0.0) >= SATURATED * self.velocity_limit > 0.0


@dataclass(frozen=True, slots=True)
class ConstraintError:
    """Active equality constraint, such as a mimic, a gearbox, a closed loop or a weld.

    Attributes:
        name: name of the constraint: scoped name of its joint, `#` and its kind.
        kind: "joint", "weld", "connect", "tendon" or another type of MuJoCo.
        error: distance from the constraint, without sign.
        unit: unit of the error, "rad" or "m".
        force: force with which the constraint acts [N, or N·m for rad].
    """

    name: str
    kind: str
    error: float
    unit: str
    force: float


@dataclass(frozen=True, slots=True)
class MomentContents:
    """State of a simulation at one time, in numbers.

    Attributes:
        world: name of the world.
        time: simulated time [s].
        tick: number of steps.
        model: scoped name of the model that the contents are limited to; empty for all.
        contacts: pairs of collisions that touch.
        joints: joints that can move.
        constraints: active equality constraints, the largest error first.
        wheels: slip of each wheel.
    """

    world: str
    time: float
    tick: int
    model: str
    contacts: tuple[TouchingPair, ...]
    joints: tuple[JointLoad, ...]
    constraints: tuple[ConstraintError, ...]
    wheels: tuple[WheelSlip, ...]
