"""Elevator of Gazebo Classic: `libElevatorPlugin.so`, and with a ROS topic `libgazebo_ros_elevator.so`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, Literal

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import listens
from simkit.plugins.find_entities import find_axis_joint, read_topic
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.plugins.options import Options, OptionsOf, integer, number, text
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import String
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel

Phase = Literal["idle", "closing first", "moving", "opening", "waiting", "closing"]

STRING: Final = "std_msgs/msg/String"
_AFTER: Final[dict[Phase, Phase]] = {
    "closing first": "moving",
    "moving": "opening",
    "opening": "waiting",
    "waiting": "closing",
    "closing": "idle",
}
_LIFT: Final = (1e5, 1e5)
"""Gains of the cabin's controller [N/m, N·s/m]."""
_DOOR: Final = (2.0, 1.0)
_OPEN: Final = 1.0  # [m or rad]
_CABIN_WITHIN: Final = 0.15  # [m]
_DOOR_WITHIN: Final = 0.05
_FLOOR: Final = re.compile(r"\s*[-+]?\d+")


class ElevatorPluginOptions(Options):
    """Options of `ElevatorPlugin`."""

    door_wait_time: float = number(5.0, "s", minimum=0.0, maximum=1e9)
    floor_height: float = number(3.0, "m", minimum=-1e6, maximum=1e6)
    lift_joint: str = text(required=True)
    door_joint: str = text(required=True)
    topic: str = text()


class ElevatorPlugin(ModelPlugin):
    """Closes the door, moves the cabin to the requested floor, opens the door, waits, and closes the door.

    The command is the floor number as text. The distance between floors is `<floor_height>`; at floor 0 the position of
    `<lift_joint>` is 0. `<door_joint>` is open at 1 and closed at 0. A command is ignored until the previous command is
    completed, as in Gazebo. The topic is `<topic>`, by default `~/elevator`, which is `/gazebo/<world>/elevator`.

    The cabin and the door are moved by springs and dampers with Gazebo's gains: 10⁵ N/m and 10⁵ N·s/m for the cabin, 2
    N/m and 1 N·s/m for the door. Gazebo damps the rate of the position error, which causes a very large force on the
    cabin when the target floor changes, and Gazebo's damping of the door decreases over time. simkit damps the speed
    instead. The waiting time is simulated time; Gazebo uses wall-clock time.
    """

    endpoints = (listens("/gazebo/{world}/elevator", STRING, named_by=("topic",)),)
    options = OptionsOf(ElevatorPluginOptions)
    filenames = ("libElevatorPlugin.so",)
    drives = True
    _bottom: int | None = None
    _top: int | None = None

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._wait_ns = round(self.options.door_wait_time * 1e9)
        self._height = self.options.floor_height
        if not params.has("floor_height"):
            params.warning("SK-PLUGIN-137", f"plugin {self.name!r} has no <floor_height>: floors are 3 m apart")
        joints = [self._joint(scene, params, element) for element in ("lift_joint", "door_joint")]
        self._joints = [joint.scoped for joint in joints if joint is not None]
        strengths = (_LIFT, _DOOR)
        self._servos = [
            builder.add_position_servo(joint.scoped, max_effort=float("inf"), owner=self.name, kp=p, kv=d)
            for joint, (p, d) in zip(joints, strengths, strict=True)
            if joint is not None
        ]

    def _joint(self, scene: SceneModel, params: Params, element: str) -> SceneJoint | None:
        name = params.text(element, required=True)
        named = params.child(element)
        return find_axis_joint(scene, name, named) if named is not None else None

    def load(self, parent: Model, params: Params) -> None:
        self._lift, self._door = (JointAxis(self.sim.joint(name)) for name in self._joints)
        self._phase: Phase = "idle"
        self._floor, self._until_ns = 0, 0
        self.before_step_rate = NEVER
        self.open_topic(params)

    def open_topic(self, params: Params) -> None:
        """Subscribe to the commands."""
        prefix = f"/gazebo/{self.sim.world.name}"
        topic = self.options.topic
        default = read_topic(params, "topic", f"{prefix}/elevator")
        self.listen(valid_topic(f"{prefix}/{topic[2:]}") if topic.startswith("~/") else default, STRING, self._on_floor)

    # ------------------------------------------------------------------ commands

    def _on_floor(self, message: String) -> None:
        match = _FLOOR.match(message.data)
        if match is None or len(match[0]) > 9:
            self._once.left_out("text", f"{message.data[:40]!r} is not a floor number; the command is ignored")
            return
        floor = int(match[0])
        if self._bottom is not None and floor < self._bottom:
            self._beyond(floor, f"the lowest floor is {self._bottom}")
        elif self._top is not None and floor > self._top:
            self._beyond(floor, f"the highest floor is {self._top}")
        elif self._phase == "idle":
            self._floor = floor
            self._go("closing first")

    def _beyond(self, floor: int, limit: str) -> None:
        self._once.left_out(f"floor {floor}", f"there is no floor {floor}: {limit}; the command is ignored")

    def before_step(self) -> None:
        """Start the next phase when the current phase has ended."""
        phase = self._phase
        if phase == "moving":
            is_over = abs(self._lift.position - self._floor * self._height) < _CABIN_WITHIN
        elif phase == "waiting":
            is_over = self.sim.time_ns >= self._until_ns
        else:
            target = _OPEN if phase == "opening" else 0.0
            is_over = abs(self._door.position - target) < _DOOR_WITHIN
        if phase != "idle" and is_over:
            self._go(_AFTER[phase])

    def _go(self, phase: Phase) -> None:
        self._phase = phase
        if phase == "moving":
            self._hold(0, self._floor * self._height)
        elif phase == "waiting":
            self._until_ns = self.sim.time_ns + self._wait_ns
        elif phase != "idle":
            self._hold(1, _OPEN if phase == "opening" else 0.0)
        self._set_before_step_rate(NEVER if phase == "idle" else None)

    def _hold(self, number: int, position: float) -> None:
        """Set the target of the servo of the cabin (0) or the door (1)."""
        sim = self.sim
        sim.mj_data.ctrl[sim.engine.names.actuator(self._servos[number])] = position
        sim.engine.physics.changed(CONTROL)


class GazeboRosElevatorOptions(ElevatorPluginOptions):
    """Options of `GazeboRosElevator`."""

    bottom_floor: int = integer()
    top_floor: int = integer()


class GazeboRosElevator(ElevatorPlugin):
    """Moves an elevator like `libElevatorPlugin.so`, from `<bottom_floor>` to `<top_floor>`.

    Commands come on the ROS topic `elevator` (ROS 1: `<topic>`).
    """

    endpoints = (listens("elevator", STRING, named_by=("topic",)),)
    options = OptionsOf(GazeboRosElevatorOptions)
    filenames = ("libgazebo_ros_elevator.so",)

    def open_topic(self, params: Params) -> None:
        """Subscribe to the commands."""
        self.listen(self.options.topic or "elevator", STRING, self._on_floor)
        self._bottom = self.options.bottom_floor if params.has("bottom_floor") else None
        self._top = self.options.top_floor if params.has("top_floor") else None
        if self._bottom is not None and self._top is not None and self._top < self._bottom:
            message = f"plugin {self.name!r}: <top_floor> {self._top} is below <bottom_floor> {self._bottom}"
            params.diagnostics.warning("SK-PLUGIN-135", f"{message}; it never moves", self.where)
