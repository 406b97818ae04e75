"""Joint trajectory controllers of ROS 1 and of UR robots, and PAL's joint impedance controller."""

from __future__ import annotations

from typing import ClassVar

from simkit_control.controllers.joint_trajectory import JointTrajectoryController
from simkit_control.plugins.ros2_control.gravity_efforts import GravityEfforts
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY
from simkit_control.plugins.ros2_control.joint_pids import JointPids


class PositionJointTrajectoryController(JointTrajectoryController):
    """Follows trajectories by position commands, as the ROS 1 controller does."""

    types: ClassVar[tuple[str, ...]] = ("position_controllers/JointTrajectoryController",)
    default_commands: ClassVar[tuple[str, ...]] = ("position",)
    default_states = ("position", "velocity")
    topics: ClassVar[tuple[str, ...]] = ("~/command", "~/joint_trajectory")
    may_end_moving = True


class VelocityJointTrajectoryController(PositionJointTrajectoryController):
    """Follows trajectories by velocity commands from PIDs, as the ROS 1 controller does."""

    types = ("velocity_controllers/JointTrajectoryController",)
    default_commands = ("velocity",)


class EffortJointTrajectoryController(PositionJointTrajectoryController):
    """Follows trajectories by effort commands from PIDs, as the ROS 1 controller does."""

    types = (
        "effort_controllers/JointTrajectoryController",
        "robot_mechanism_controllers/JointTrajectoryActionController",
        "robot_mechanism_controllers/JointSplineTrajectoryController",
    )
    default_commands = ("effort",)


class PositionVelocityJointTrajectoryController(PositionJointTrajectoryController):
    """Follows trajectories by position and velocity commands, as the ROS 1 controller does."""

    types = ("pos_vel_controllers/JointTrajectoryController",)
    default_commands = ("position", "velocity")


class ScaledJointTrajectoryController(JointTrajectoryController):
    """Follows trajectories at full speed, as on a UR robot whose speed slider is at 100 %.

    The simulation has no control box whose speed scaling the controller could read.
    """

    types = ("ur_controllers/ScaledJointTrajectoryController",)

    def configure(self) -> None:
        self.params.child("speed_scaling_interface_name")
        super().configure()


class ImpedanceController(JointTrajectoryController):
    """Pulls joints along a trajectory by springs and dampers, with gravity compensation (PAL's impedance control).

    The controller works like a joint trajectory controller with effort commands. Its gains are `kp` and `kd` in
    `impedance_gains.<joint>`. On the robot they are gains of the motors, and a motor that is mounted in reverse has
    negative gains. The stiffness at the joint is |kp| · `motor_params.<joint>.reduction_ratio` [N·m/rad]. The damping
    at the joint is |kd| times the same ratio [N·m·s/rad].
    """

    types = ("impedance_controllers/JointTrajectoryController",)
    default_commands: ClassVar[tuple[str, ...]] = (EFFORT,)
    default_states: ClassVar[tuple[str, ...]] = (POSITION, VELOCITY)

    def configure(self) -> None:
        super().configure()
        for element in self.params.all("robot_model_chains"):
            element.mark_all_read()
        joints = [name for name in self._group.commanded_joints if name in self.hardware.joints]
        self._gravity = GravityEfforts(self.sim, [self.hardware.joints[name].scoped for name in joints])
        self.hardware.springs[self.name] = dict(zip(joints, self._springs, strict=False))

    def _read_gains(self) -> JointPids | None:
        gains, motors = self.params.block("impedance_gains"), self.params.block("motor_params")
        self._springs = []
        for joint in (self._group.joints[index] for index in self._group.commanded_indices):
            gain, motor = gains.block(joint), motors.block(joint)
            motor.child("motor_torque_constant")
            ratio = motor.number("reduction_ratio", 1.0, minimum=1e-9)
            self._springs.append((abs(gain.number("kp", 0.0)) * ratio, abs(gain.number("kd", 0.0)) * ratio))
        return None  # the engine simulates the springs

    def update(self, now_ns: int, period: float) -> None:
        super().update(now_ns, period)
        if self._command is not None:
            kp, kd = self.hardware.actuated.spring_gains(self._group.commanded_joints)
            position, velocity = self._command.motion[:2, self._group.commanded_indices]
            self.commands.values = kp * position + kd * velocity + self._gravity.efforts()
