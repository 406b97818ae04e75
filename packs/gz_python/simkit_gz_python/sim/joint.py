"""Handle of a joint with the interface of gz-sim's Python class `Joint`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from simkit_gz_python.math.pose import Pose3d
from simkit_gz_python.math.simkit_conversion import gz_pose
from simkit_gz_python.math.value_base import HasComponents
from simkit_gz_python.msgs import message_class
from simkit_gz_python.msgs.message import Message
from simkit_gz_python.sdformat import JointAxis, JointType
from simkit_gz_python.sim.entity_view import EntityView
from simkit_gz_python.sim.model import PartOfModel

_POSITION, _VELOCITY, _WRENCH = "position", "velocity", "wrench"


class Joint(PartOfModel):
    """Joint of a model.

    A system must enable the readings position, velocity and wrench. A disabled reading is None; an enabled reading is
    an empty list before the next step.
    """

    KIND = "joint"

    # ------------------------------------------------------------------ description

    def parent_link_name(self, ecm: EntityView) -> str | None:
        """Return the name of the parent link relative to the model; `world` if the joint is attached to the world."""
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
        """Return the pose of the joint in the frame of the child link."""
        scene = self._scene(ecm)
        if scene is None:
            return None
        child = ecm.sync().link(scene.child_link)
        if child is None:
            return gz_pose(scene.pose_world)
        return gz_pose(child.scene.pose_world.inverse() @ scene.pose_world)

    def thread_pitch(self, ecm: EntityView) -> float | None:
        """Return the pitch of a screw joint [m per turn]."""
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
        """Return the position, one number for each axis [rad or m]."""
        return self._values(ecm, _POSITION)

    def velocity(self, ecm: EntityView) -> list[float] | None:
        """Return the velocity, one number for each axis [rad/s or m/s]."""
        return self._values(ecm, _VELOCITY)

    def _values(self, ecm: EntityView, reading: str) -> list[float] | None:
        is_read, joint = self._reading(ecm, reading), self._handle(ecm)
        if is_read is None or joint is None:
            return None
        values: list[float] = np.atleast_1d(getattr(joint, reading)).tolist() if is_read else []
        return values

    def transmitted_wrench(self, ecm: EntityView) -> list[Message] | None:
        """Return a list of one `gz.msgs` Wrench, with force [N] and torque [N·m] in the joint frame.

        The parent link exerts them on the child link.
        """
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
        """Command the velocity of each axis [rad/s or m/s] at the end of the next step, within the effort limits.

        As in gz-sim, later steps without a new command hold the joint at rest. The command has no effect on a joint
        that has ever received a force.
        """
        if self.valid(ecm):
            ecm.commands.velocity[self._entity] = self._numbers(velocities)

    def set_force(self, ecm: EntityView, forces: Sequence[float]) -> None:
        """Command the effort of each axis [N·m or N] for the next step, within the effort limits."""
        if self.valid(ecm):
            ecm.commands.force[self._entity] = self._numbers(forces)

    def reset_position(self, ecm: EntityView, positions: Sequence[float]) -> None:
        """Set the position of each axis [rad or m] once, before the next step."""
        if self.valid(ecm):
            ecm.commands.position_reset[self._entity] = self._numbers(positions)

    def reset_velocity(self, ecm: EntityView, velocities: Sequence[float]) -> None:
        """Set the velocity of each axis [rad/s or m/s] once, before the next step."""
        if self.valid(ecm):
            ecm.commands.velocity_reset[self._entity] = self._numbers(velocities)

    def set_position_limits(self, ecm: EntityView, limits: Sequence[HasComponents]) -> None:
        """Set the position limits of each axis as `Vector2d` (lower, upper) [rad or m]."""
        self._limit(ecm, "position", limits)

    set_position_imits = set_position_limits  # gz-sim 8 has this spelling

    def set_velocity_limits(self, ecm: EntityView, limits: Sequence[HasComponents]) -> None:
        """Set the velocity limit of each axis to the larger absolute value of its pair [rad/s or m/s]."""
        self._limit(ecm, "velocity", limits)

    def set_effort_limits(self, ecm: EntityView, limits: Sequence[HasComponents]) -> None:
        """Set the effort limit of each axis to the larger absolute value of its pair [N·m or N]."""
        self._limit(ecm, "effort", limits)

    def _limit(self, ecm: EntityView, what: str, limits: Sequence[HasComponents]) -> None:
        if self.valid(ecm):
            pairs = tuple((float(limit.x()), float(limit.y())) for limit in limits)
            ecm.commands.limits[self._entity, what] = pairs

    @staticmethod
    def _numbers(values: Sequence[float]) -> tuple[float, ...]:
        """Convert values to numbers; raise ValueError for a NaN or infinite number."""
        numbers = tuple(float(np.asarray(v).item()) for v in values)  # an array of one number is also a valid value
        if not np.isfinite(numbers).all():
            raise ValueError(f"expected finite numbers for a joint, got {list(numbers)}")
        return numbers
