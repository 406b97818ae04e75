"""Joints as gz-sim's Python shows them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from simkit.plugins.gz_python.math.pose import Pose3d
from simkit.plugins.gz_python.math.simkit_conversion import gz_pose
from simkit.plugins.gz_python.math.value_base import HasComponents
from simkit.plugins.gz_python.msgs import message_class
from simkit.plugins.gz_python.msgs.message import Message
from simkit.plugins.gz_python.sdformat import JointAxis, JointType
from simkit.plugins.gz_python.sim.entity_view import EntityView
from simkit.plugins.gz_python.sim.model import PartOfModel

_POSITION, _VELOCITY, _WRENCH = "position", "velocity", "wrench"


class Joint(PartOfModel):
    """A joint. Position, velocity and wrench are None until they are enabled, and empty until a step has passed."""

    KIND = "joint"

    # ------------------------------------------------------------------ what it is

    def parent_link_name(self, ecm: EntityView) -> str | None:
        """As seen from its model; `world` where it hangs on the world."""
        return self._end(ecm, "parent_link")

    def child_link_name(self, ecm: EntityView) -> str | None:
        return self._end(ecm, "child_link")

    def _end(self, ecm: EntityView, which: str) -> str | None:
        record = self._record(ecm)
        if record is None:
            return None
        model = ecm.record(record.parent)
        scope = f"{model.scene.scoped}::" if model is not None else ""
        return str(getattr(record.scene, which)).removeprefix(scope)

    def pose(self, ecm: EntityView) -> Pose3d | None:
        """In its child link's frame."""
        scene = self._scene(ecm)
        if scene is None:
            return None
        child = ecm.sync().link(scene.child_link)
        if child is None:
            return gz_pose(scene.pose_world)
        return gz_pose(child.scene.pose_world.inverse() @ scene.pose_world)

    def thread_pitch(self, ecm: EntityView) -> float | None:
        """Return the pitch of a screw [m per turn]."""
        scene = self._scene(ecm)
        return float(scene.thread_pitch) if scene is not None else None

    def axis(self, ecm: EntityView) -> list[JointAxis] | None:
        scene = self._scene(ecm)
        return [JointAxis(axis) for axis in scene.axes] if scene is not None else None

    def type(self, ecm: EntityView) -> JointType | None:
        scene = self._scene(ecm)
        return JointType.__members__.get(scene.type.upper(), JointType.INVALID) if scene is not None else None

    # ------------------------------------------------------------------ readings

    def enable_position_check(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _POSITION, enable)

    def enable_velocity_check(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _VELOCITY, enable)

    def enable_transmitted_wrench_check(self, ecm: EntityView, enable: bool = True) -> None:
        self._enable(ecm, _WRENCH, enable)

    def position(self, ecm: EntityView) -> list[float] | None:
        """[rad or m], one number for each axis."""
        return self._values(ecm, _POSITION)

    def velocity(self, ecm: EntityView) -> list[float] | None:
        """[rad/s or m/s], one number for each axis."""
        return self._values(ecm, _VELOCITY)

    def _values(self, ecm: EntityView, what: str) -> list[float] | None:
        is_read, joint = self._reading(ecm, what), self._handle(ecm)
        if is_read is None or joint is None:
            return None
        values: list[float] = np.atleast_1d(getattr(joint, what)).tolist() if is_read else []
        return values

    def transmitted_wrench(self, ecm: EntityView) -> list[Message] | None:
        """One `gz.msgs` Wrench: force [N] and torque [N·m] by the parent on the child, in the joint frame."""
        is_read, joint = self._reading(ecm, _WRENCH), self._handle(ecm)
        if is_read is None or joint is None:
            return None
        if not is_read:
            return []
        message = message_class("Wrench")()
        for part, values in zip((message.force, message.torque), joint.transmitted_wrench, strict=True):
            part.x, part.y, part.z = (float(v) for v in values)
        return [message]

    # ------------------------------------------------------------------ commands

    def set_velocity(self, ecm: EntityView, velocities: Sequence[float]) -> None:
        """Velocities [rad/s or m/s] to have after the next step, as far as the effort limits go.

        As in gz-sim the joint is then held at rest from step to step unless it is set again, and nothing happens
        to a joint that was ever given a force.
        """
        if self.valid(ecm):
            ecm.commands.velocity[self._entity] = self._numbers(velocities)

    def set_force(self, ecm: EntityView, forces: Sequence[float]) -> None:
        """Efforts [N·m or N] for the next step, within the limits."""
        if self.valid(ecm):
            ecm.commands.force[self._entity] = self._numbers(forces)

    def reset_position(self, ecm: EntityView, positions: Sequence[float]) -> None:
        """Puts the joint there [rad or m] before the next step, once."""
        if self.valid(ecm):
            ecm.commands.position_reset[self._entity] = self._numbers(positions)

    def reset_velocity(self, ecm: EntityView, velocities: Sequence[float]) -> None:
        """Gives the joint these velocities [rad/s or m/s] before the next step, once."""
        if self.valid(ecm):
            ecm.commands.velocity_reset[self._entity] = self._numbers(velocities)

    def set_position_limits(self, ecm: EntityView, limits: Sequence[HasComponents]) -> None:
        """(lower, upper) [rad or m] for each axis, as `Vector2d`."""
        self._limit(ecm, "position", limits)

    set_position_imits = set_position_limits  # so it is spelled in gz-sim 8

    def set_velocity_limits(self, ecm: EntityView, limits: Sequence[HasComponents]) -> None:
        """The larger magnitude of each pair [rad/s or m/s] counts."""
        self._limit(ecm, "velocity", limits)

    def set_effort_limits(self, ecm: EntityView, limits: Sequence[HasComponents]) -> None:
        """The larger magnitude of each pair [N·m or N] counts."""
        self._limit(ecm, "effort", limits)

    def _limit(self, ecm: EntityView, what: str, limits: Sequence[HasComponents]) -> None:
        if self.valid(ecm):
            pairs = tuple((float(one.x()), float(one.y())) for one in limits)
            ecm.commands.limits[self._entity, what] = pairs

    @staticmethod
    def _numbers(values: Sequence[float]) -> tuple[float, ...]:
        """Finite numbers; ValueError for others."""
        found = tuple(float(np.asarray(v).item()) for v in values)  # an array of one number too
        if not np.isfinite(found).all():
            raise ValueError(f"a joint takes finite numbers, got {list(found)}")
        return found
