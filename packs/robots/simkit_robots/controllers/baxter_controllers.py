"""Controllers of the robot Baxter, with the names that baxter_simulator gives to them.

The plugin `libbaxter_gazebo_ros_control.so` declares and switches these controllers, and hands the commands over to
them. Sources: `baxter_sim_controllers` of RethinkRobotics/baxter_simulator, and the page "Arm Control Modes" of the
robot's SDK for the speed ratio and the gravity compensation.
"""

from __future__ import annotations

import abc
import json
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from simkit.extend import did_you_mean
from simkit_control.controllers.joint_trajectory_kinds import PositionJointTrajectoryController
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.gravity_efforts import GravityEfforts
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY

if TYPE_CHECKING:
    from simkit.extend import GoalHandle, Vector
    from simkit.msgs import EndEffectorCommand, JointTrajectory

LIMB_JOINTS: Final = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")
"""Names of an arm's joints without the side, from the shoulder to the wrist."""
SUPPRESSION_TIME: Final = 0.2
"""Time for which one message switches the gravity compensation off [s]: the messages must arrive at 5 Hz or more."""
_GRIPPER_COMMANDS: Final = (
    *("no_op", "set", "configure", "reboot", "reset", "calibrate", "clear_calibration", "prepare_to_grip"),
    *("grip", "release", "go", "stop"),
)
_HEAD_SPEED: Final = 1.0  # speed of the head at a speed ratio of 1 [rad/s]; not published
_FINGER_SPEED: Final = 0.05  # speed of a finger at 100 % [m/s]; not published


def limb_joints(side: str) -> tuple[str, ...]:
    """Return the names of the joints of an arm, from the shoulder to the wrist."""
    return tuple(f"{side}_{joint}" for joint in LIMB_JOINTS)


class BaxterController(Controller):
    """Base class: the controller's joints follow from its parameter `joints`, or from its name.

    The parameter file of baxter_simulator names each joint in a block with its gains, which the plugin reads.

    Attributes:
        interface: command interface.
        joints: names of the joints.
    """

    interface: ClassVar[str] = POSITION
    joints: tuple[str, ...]

    def configure(self) -> None:
        for name in ("topic", "properties"):  # the plugin subscribes to the topics of the robot
            self.params.child(name)
        named = [child.text("joint", "") for child in self.params.block("joints").children]
        self.params.block("joints").mark_all_read()
        self.joints = self.usual_joints()
        if any(named) and not set(self.joints) <= set(named):
            message = f"'joints' of controller {self.name!r} are {', '.join(named)}"
            self.params.error("SK-CONTROL-024", message, f"a controller of this name drives {', '.join(self.joints)}")

    def usual_joints(self) -> tuple[str, ...]:
        """Return the joints that a controller of this name drives."""
        return limb_joints(self.name.partition("_")[0])

    def command_interfaces(self) -> Sequence[str]:
        return [f"{joint}/{self.interface}" for joint in self.joints]

    def state_interfaces(self) -> Sequence[str]:
        return [f"{joint}/{POSITION}" for joint in self.joints]

    def _max_velocities(self) -> Vector:
        # an infinite limit times a speed ratio of 0 would be NaN
        return np.array([min(self.hardware.joints[joint].max_velocity, 1e9) for joint in self.joints])


class BaxterLimbController(BaxterController, abc.ABC):
    """Base class of the controllers of one arm; a joint that a command does not name keeps its last command.

    Attributes:
        mode: number of the mode in the last command.
        target: last command of each joint [rad, rad/s or N·m]; NaN without one.
    """

    mode: int = 0
    target: Vector

    def activate(self) -> None:
        """Forget the commands before the activation."""
        self.target = np.full(len(self.joints), np.nan)

    def set_command(self, values: Mapping[str, float], mode: int) -> None:
        """Set the commands of some joints."""
        self.mode = mode
        for joint, value in values.items():
            self.target[self.joints.index(joint)] = value

    @property
    def commanded(self) -> Vector:
        """Last command of each joint; 0 without one."""
        return np.nan_to_num(self.target)


class BaxterPositionController(BaxterLimbController):
    """Moves an arm to positions, at most at `speed_ratio` times the velocity limits; a raw position at the limits.

    Attributes:
        speed_ratio: share of the velocity limits, from 0 to 1.
    """

    types = ("baxter_sim_controllers/BaxterPositionController",)
    speed_ratio = 0.3

    def activate(self) -> None:
        super().activate()
        self._reference = self.states.values

    def update(self, now_ns: int, period: float) -> None:
        if self.mode == 4:
            self._reference = np.where(np.isnan(self.target), self._reference, self.target)
        else:
            farthest = self.speed_ratio * self._max_velocities() * period
            missing = np.nan_to_num(self.target - self._reference)
            self._reference = self._reference + np.clip(missing, -farthest, farthest)
        self.commands.values = self._reference


class BaxterVelocityController(BaxterLimbController):
    """Moves the joints of an arm at velocities; a joint without a command stands still."""

    types = ("baxter_sim_controllers/BaxterVelocityController",)
    interface = VELOCITY

    def update(self, now_ns: int, period: float) -> None:
        self.commands.values = self.commanded


class BaxterEffortController(BaxterLimbController):
    """Applies torques to the joints of an arm, in addition to the torques that balance gravity.

    Attributes:
        suppressed_until: time until which gravity is not balanced [ns].
    """

    types = ("baxter_sim_controllers/BaxterEffortController",)
    interface = EFFORT
    suppressed_until = 0
    _share = 1.0

    def configure(self) -> None:
        super().configure()
        known = [self.hardware.joints[joint].scoped for joint in self.joints if joint in self.hardware.joints]
        self._gravity = GravityEfforts(self.sim, known)

    def deactivate(self) -> None:
        self.commands.values = np.zeros(len(self.joints))
        self._set_gravity_share(1.0)

    def update(self, now_ns: int, period: float) -> None:
        share = 0.0 if now_ns < self.suppressed_until else 1.0
        self._set_gravity_share(share)
        self.commands.values = self.commanded + share * self._gravity.efforts()

    def _set_gravity_share(self, share: float) -> None:
        """Set whether the efforts against gravity are added to the limits of the joints, 1, or not, 0."""
        if share == self._share:
            return
        self._share, actuated = share, self.hardware.actuated
        if actuated.gravity_shares is not None:
            mine = [joint.name in self.joints for joint in actuated.joints]
            actuated.gravity_shares = np.where(mine, share, actuated.gravity_shares)


class BaxterTrajectoryController(PositionJointTrajectoryController):
    """Follows trajectories of one arm, as the action server of baxter_interface does; holds the arm without a goal.

    The action is `limb/<side>/follow_joint_trajectory` in the robot's namespace. The errors during the motion may reach
    0.2 rad, the default of that server; a goal ends at the time of its last point.
    """

    types = ("baxter_interface/JointTrajectoryActionServer",)
    topics = ("~/joint_trajectory",)

    def topic(self, name: str) -> str:
        side = self.name.partition("_")[0]
        return super().topic(name.replace("~/", f"limb/{side}/", 1))

    def _on_trajectory(self, message: JointTrajectory) -> None:
        refusal = self.plugin.prepare_trajectory(self.name.partition("_")[0])  # type: ignore[attr-defined]
        if refusal:
            self._warnings.warn("SK-CONTROL-020", refusal, f"a trajectory is ignored: {refusal}")
        super()._on_trajectory(message)

    def _on_goal(self, goal: GoalHandle) -> None:
        refusal = self.plugin.prepare_trajectory(self.name.partition("_")[0])  # type: ignore[attr-defined]
        if refusal:
            goal.reject(refusal)
            return
        super()._on_goal(goal)


class BaxterHeadController(BaxterController):
    """Turns the head to an angle, at most at `speed_ratio` · 1 rad/s.

    Attributes:
        target: commanded angle [rad].
        speed_ratio: share of the largest speed, from 0 to 1; 0 means 1, because a message without the field has 0.
    """

    types = ("baxter_sim_controllers/BaxterHeadController",)
    target = 0.0
    speed_ratio = 1.0

    def usual_joints(self) -> tuple[str, ...]:
        return ("head_pan",)

    def activate(self) -> None:
        self.target = self._reference = float(self.states.values[0])

    def set_command(self, target: float, speed_ratio: float) -> None:
        """Set the angle [rad] and the speed ratio; both are clamped to their ranges."""
        joint = self.hardware.joints[self.joints[0]]
        self.target = min(max(target, joint.lower), joint.upper)
        self.speed_ratio = min(max(speed_ratio, 0.0), 1.0)

    def update(self, now_ns: int, period: float) -> None:
        farthest = _HEAD_SPEED * (self.speed_ratio or 1.0) * period
        self._reference += min(max(self.target - self._reference, -farthest), farthest)
        self.commands.values = np.array([self._reference])


class BaxterGripperController(BaxterController):
    """Moves the fingers of an electric gripper; the second finger mimics the first one.

    Attributes:
        target: commanded opening, from 0 (closed) to 1 (open).
        velocity: speed of the fingers, as a share of 0.05 m/s.
        dead_zone: largest difference of the opening at which a motion has succeeded.
        is_calibrated: true unless a command has cleared the calibration.
        last: command, sender and sequence number of the last message.
    """

    types = ("baxter_sim_controllers/BaxterGripperController",)
    target = math.nan
    velocity = 0.5
    dead_zone = 0.05
    is_calibrated = True
    last: tuple[str, str, int] = ("", "", 0)

    def usual_joints(self) -> tuple[str, ...]:
        return (finger_joint(self.name.partition("_")[0]),)

    def configure(self) -> None:
        super().configure()
        joint = self.hardware.joints.get(self.joints[0])
        self._range = (joint.lower, joint.upper) if joint is not None else (0.0, 1.0)

    def opening(self, position: float) -> float:
        """Return the share of the finger's travel, from 0 (closed) to 1 (open)."""
        lower, upper = self._range
        return (position - lower) / (upper - lower) if math.isfinite(upper - lower) else 0.0

    def activate(self) -> None:
        self._reference = float(self.states.values[0])
        self.target = self.opening(self._reference)

    def execute(self, message: EndEffectorCommand) -> tuple[str, str]:
        """Execute a command; return the problem and what to do about it, or two empty texts."""
        command = str(message.command)
        if command not in _GRIPPER_COMMANDS:
            near = did_you_mean(command, _GRIPPER_COMMANDS) or f"use one of {', '.join(_GRIPPER_COMMANDS)}"
            return f"the gripper command {command[:100]!r} is not known", near
        values = _numbers_of(str(message.args))
        if values is None:
            problem = f"the gripper command {command!r} has the arguments {str(message.args)[:100]!r}"
            return problem, 'give finite numbers by name: {"position": 50.0}'
        if command == "go" and "position" in values:
            self.target = min(max(values["position"] / 100.0, 0.0), 1.0)
        elif command in ("grip", "release"):
            self.target = float(command == "release")
        elif command in ("go", "stop"):
            self.activate()  # hold the present position
        elif command in ("set", "configure"):
            self.velocity = min(max(values.get("velocity", 100.0 * self.velocity), 0.0), 100.0) / 100.0
            self.dead_zone = min(max(values.get("dead_zone", 100.0 * self.dead_zone), 0.0), 100.0) / 100.0
        elif command in ("calibrate", "clear_calibration"):
            self.is_calibrated = command == "calibrate"
        self.last = (command, str(message.sender), int(message.sequence))
        return "", ""

    def update(self, now_ns: int, period: float) -> None:
        lower, upper = self._range
        farthest = self.velocity * _FINGER_SPEED * period
        missing = lower + self.target * (upper - lower) - self._reference
        self._reference += min(max(missing, -farthest), farthest)
        self.commands.values = np.array([self._reference])


def _numbers_of(text: str) -> dict[str, float] | None:
    """Return the finite numbers of a JSON object by name; None if the text is not such an object."""
    try:
        numbers = {str(name): float(value) for name, value in json.loads(text or "{}").items()}
    except (ValueError, TypeError, AttributeError, RecursionError):
        return None
    return numbers if all(math.isfinite(value) for value in numbers.values()) else None


def finger_joint(side: str) -> str:
    """Return the name of the joint of a gripper's leading finger."""
    return f"{side[0]}_gripper_l_finger_joint"
