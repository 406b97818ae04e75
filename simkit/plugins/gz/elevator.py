"""Elevator of Gazebo: `gz::sim::systems::Elevator`."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Final, Literal

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_axis_joint, find_link, read_topic
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.plugins.options import Options, OptionsOf, number, text
from simkit.plugins.publish_on_demand import publish_while_subscribed

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

Phase = Literal["idle", "moving", "opening", "waiting", "closing"]

DOUBLE: Final = "std_msgs/msg/Float64"
INT: Final = "std_msgs/msg/Int32"
_FARTHEST: Final = 1e6
"""Largest opening of a door [m]. A larger upper limit means that the axis has no limit."""
_CABIN_WITHIN: Final = 0.15  # position tolerance of the cabin [m]
_DOOR_WITHIN: Final = 0.02  # position tolerance of a door [m]
_AT_REST: Final = 0.01  # largest speed that counts as rest [m/s]
_FREE: Final = 0.005
"""Difference between the lidar's largest range and a measured range up to which the doorway counts as free [m]."""


class ElevatorOptions(Options):
    """Options of `Elevator`."""

    update_rate: float = number(10.0, "Hz", minimum=0.0)
    state_publish_rate: float = number(5.0, "Hz", minimum=0.0)
    open_door_wait_duration: float = number(5.0, "s", minimum=0.0, maximum=1e9)
    floor_link_prefix: str = text("floor_")
    door_joint_prefix: str = text("door_")
    cabin_joint: str = text("lift")
    state_topic: str = text()
    cmd_topic: str = text()


class Elevator(ModelPlugin):
    """Moves the cabin to the floor in a message on `<cmd_topic>`, opens the door there, waits, and closes the door.

    Links `floor_0`, `floor_1`, … mark the heights of the joint `lift`. Joints `door_0`, `door_1`, … are open at their
    upper limit and closed at 0. Each joint needs a JointPositionController, which reads its target from
    `/model/<model>/joint/<joint>/0/cmd_pos`. A lidar on `/model/<model>/<door joint>/lidar` can measure the doorway:
    the door stays open while the first range is short. The elevator has a list of stops. An idle elevator executes a
    command at once. Commands that arrive during a ride or while the door is open are stored; they become stops when the
    door starts to close. Commands that arrive while the door closes become stops at once. A stop that is on the way to
    a later stop is inserted before that stop. The floor nearest to the cabin is published on `<state_topic>`.
    """

    endpoints = (
        publishes("/model/{model}/joint/{joint}/0/cmd_pos", DOUBLE),
        publishes("/model/{model}/state", INT, named_by=("state_topic",)),
        listens("/model/{model}/cmd", INT, named_by=("cmd_topic",)),
    )
    options = OptionsOf(ElevatorOptions)
    filenames = ("gz-sim-elevator-system",)
    names = ("gz::sim::systems::Elevator",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        floor, door = self.options.floor_link_prefix, self.options.door_joint_prefix
        cabin = self.options.cabin_joint
        lift = find_axis_joint(scene, cabin, params.child("cabin_joint") or params)
        self._cabin = "" if lift is None else lift.scoped
        pattern = re.compile(re.escape(floor) + r"\d+")
        count = len({link.name for link in scene.all_links() if pattern.fullmatch(link.name)})
        if not count:
            names = [link.name for link in scene.all_links()]
            message = f"plugin {self.name!r}: no link of model {scene.scoped!r} is named {floor}0; it has: "
            params.error("SK-PLUGIN-003", message + ", ".join(map(repr, names)), "set <floor_link_prefix>")
        floors = [find_link(scene, f"{floor}{k}", params) for k in range(count)]
        upright = scene.pose_world.inverse()
        self._heights = [float((upright @ link.pose_world).position[2]) for link in floors if link is not None]
        doors = [find_axis_joint(scene, f"{door}{k}", params) for k in range(count)]
        self._doors = [joint.scoped for joint in doors if joint is not None]
        self._open = [joint.axes[0].upper for joint in doors if joint is not None]
        for joint in doors:
            if joint is not None and not joint.axes[0].upper <= _FARTHEST:
                message = f"plugin {self.name!r}: door joint {joint.name!r} has no upper limit, its open position"
                params.error("SK-PLUGIN-133", message, "add <limit><upper> to its axis")
        self._joint_names = [cabin, *(f"{door}{k}" for k in range(count))]

    def load(self, parent: Model, params: Params) -> None:
        model_topic = f"/model/{parent.name}"
        axes = [JointAxis(self.sim.joint(name)) for name in (self._cabin, *self._doors)]
        self._lift, self._door_axes = axes[0], axes[1:]
        topics = [valid_topic(f"{model_topic}/joint/{name}/0/cmd_pos") for name in self._joint_names]
        self._movers = [self.advertise(topic, DOUBLE) for topic in topics]
        self._state = self.advertise(read_topic(params, "state_topic", f"{model_topic}/state"), INT)
        self._phase: Phase = "idle"
        self._targets: list[int] = []
        self._stored_commands: list[int] = []
        self._at = 0  # floor of the active door
        self._until_ns = 0
        self._was_blocked = False
        self._blocked = [False] * len(self._doors)
        self.after_step_rate = NEVER
        self.listen(read_topic(params, "cmd_topic", f"{model_topic}/cmd"), INT, self._on_command)
        for k, name in enumerate(self._joint_names[1:]):
            self.subscribe(valid_topic(f"{model_topic}/{name}/lidar"), partial(self._on_scan, k))
        rates = [rate for rate in (self.options.update_rate, self.options.state_publish_rate) if rate > 0]
        publish_while_subscribed(self, self._state, min(rates, default=0.0), "publish_floor")

    @property
    def floor(self) -> int:
        """Index of the floor nearest to the cabin."""
        height = self._lift.position
        return min(range(len(self._heights)), key=lambda k: abs(self._heights[k] - height))

    def publish_floor(self) -> None:
        """Publish the floor nearest to the cabin."""
        self._state.publish(msgs.make(INT, data=self.floor))

    # ------------------------------------------------------------------ messages

    def _on_command(self, message: msgs.Int32) -> None:
        target = int(message.data)
        if not 0 <= target < len(self._heights):
            top = len(self._heights) - 1
            self._once.left_out(f"floor {target}", f"there is no floor {target}; the floors are 0 to {top}")
        elif self._phase == "idle":
            self._add_stop(target)
            self._at = self.floor
            if self._targets[0] == self._at:
                self._targets = self._targets[1:]
                self._go("opening")
            else:
                self._go("moving")
        elif self._phase == "closing":
            self._add_stop(target)
        else:
            self._stored_commands = [*self._stored_commands, target]

    def _add_stop(self, target: int) -> None:
        """Insert a floor before the first stop that is reached after passing this floor, else at the end."""
        if target in self._targets:
            return
        before = self.floor
        for index, stop in enumerate(self._targets):
            low, high = min(before, stop), max(before, stop)
            if low <= target < high:
                self._targets = [*self._targets[:index], target, *self._targets[index:]]
                return
            before = stop
        self._targets = [*self._targets, target]

    def _on_scan(self, door: int, scan: msgs.LaserScan) -> None:
        if len(scan.ranges):
            blocked = bool(scan.ranges[0] < scan.range_max - _FREE)
            if blocked != self._blocked[door]:
                self._blocked = [*self._blocked[:door], blocked, *self._blocked[door + 1 :]]

    # ------------------------------------------------------------------ motion of cabin and doors

    def after_step(self) -> None:
        """Start the next phase if the current one has finished."""
        phase = self._phase
        if phase == "moving":
            if self._has_come(self._lift, self._heights[self._targets[0]], _CABIN_WITHIN):
                self._at, self._targets = self._targets[0], self._targets[1:]
                self._go("opening")
        elif phase == "opening":
            if self._has_come(self._door_axes[self._at], self._open[self._at], _DOOR_WITHIN):
                self._go("waiting")
        elif phase == "waiting":
            if self._has_waited():
                self._go("closing")
        elif phase == "closing" and self._has_come(self._door_axes[self._at], 0.0, _DOOR_WITHIN):
            self._go("moving" if self._targets else "idle")

    def _go(self, phase: Phase) -> None:
        self._phase = phase
        if phase == "moving":
            self._send(0, self._heights[self._targets[0]])
        elif phase == "opening":
            self._send(1 + self._at, self._open[self._at])
        elif phase == "waiting":
            self._restart_wait()
        elif phase == "closing":
            self._send(1 + self._at, 0.0)
            commands, self._stored_commands = self._stored_commands, []
            for target in commands:
                self._add_stop(target)
        self.log.info("%s: %s at floor %d", self.name, phase, self._at)
        self._set_pace()

    def _send(self, joint: int, position: float) -> None:
        mover = self._movers[joint]
        ends = self.sim.communication.bus.endpoints(mover.topic)
        if not mover.wanted and not any(does == "takes" for *_, does in ends):
            message = f"no plugin subscribes to the positions on {mover.topic}"
            hint = f"add a JointPositionController for joint {self._joint_names[joint]!r} to the model"
            self._once.warn("SK-PLUGIN-132", mover.topic, message, hint)
        mover.publish(msgs.make(DOUBLE, data=position))

    def _has_waited(self) -> bool:
        """Check whether the doorway is free, and the waiting time since its last blockage is over."""
        is_blocked, now = self._blocked[self._at], self.sim.time_ns
        if self._was_blocked and not is_blocked:
            self._restart_wait()
        self._was_blocked = is_blocked
        return not is_blocked and now >= self._until_ns

    def _restart_wait(self) -> None:
        """Restart the time [ns] for which the door stays open."""
        self._until_ns = self.sim.time_ns + round(self.options.open_door_wait_duration * 1e9)
        self._was_blocked = False

    def _has_come(self, axis: JointAxis, target: float, within: float) -> bool:
        return abs(axis.position - target) <= within and abs(axis.velocity) <= _AT_REST

    def _set_pace(self) -> None:
        """Call `after_step` at `<update_rate>` while the elevator is in use, and not at all while it is idle."""
        self._set_after_step_rate(NEVER if self._phase == "idle" else self.options.update_rate)
