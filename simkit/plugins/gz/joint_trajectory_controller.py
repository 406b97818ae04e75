"""Joint trajectory controller of Gazebo: `gz::sim::systems::JointTrajectoryController`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final, cast

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_joint
from simkit.plugins.joints.joint_axis import JointAxis, has_axis, suggest_names
from simkit.plugins.joints.joint_commands import ControlledJoints
from simkit.plugins.joints.joint_trajectory import (
    INTERPOLATIONS,
    Interpolation,
    JointPath,
    JointTarget,
    TrajectoryPoint,
    active_point,
    nanoseconds,
    read_points,
    trajectory_faults,
)
from simkit.plugins.joints.pid import FIELDS, Pid, declare_pid
from simkit.plugins.options import Options, OptionsOf, choice, numbers, text, texts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel

TRAJECTORY: Final = "trajectory_msgs/msg/JointTrajectory"
PROGRESS: Final = "std_msgs/msg/Float32"
_ONE_AXIS: Final = frozenset({"revolute", "continuous", "prismatic", "gearbox"})
_DEFAULTS: Final = {"i_max": -1.0, "cmd_max": -1.0}


@dataclass(slots=True)
class _Axis:
    """Joint with its two controllers and its present targets."""

    joint: JointAxis
    position_pid: Pid
    velocity_pid: Pid
    position: float
    velocity: float = 0.0
    effort: float = 0.0
    path: JointPath | None = None


class JointTrajectoryControllerOptions(Options):
    """Options of `JointTrajectoryController`."""

    joint_name: tuple[str, ...] = texts()
    position_p_gain: tuple[float, ...] = numbers()
    position_i_gain: tuple[float, ...] = numbers()
    position_d_gain: tuple[float, ...] = numbers()
    position_i_max: tuple[float, ...] = numbers()
    position_i_min: tuple[float, ...] = numbers()
    position_cmd_max: tuple[float, ...] = numbers()
    position_cmd_min: tuple[float, ...] = numbers()
    position_cmd_offset: tuple[float, ...] = numbers()
    velocity_p_gain: tuple[float, ...] = numbers()
    velocity_i_gain: tuple[float, ...] = numbers()
    velocity_d_gain: tuple[float, ...] = numbers()
    velocity_i_max: tuple[float, ...] = numbers()
    velocity_i_min: tuple[float, ...] = numbers()
    velocity_cmd_max: tuple[float, ...] = numbers()
    velocity_cmd_min: tuple[float, ...] = numbers()
    velocity_cmd_offset: tuple[float, ...] = numbers()
    initial_position: tuple[float, ...] = numbers()
    use_header_start_time_attribute: str = text(element="@use_header_start_time")
    interpolation: str = choice(INTERPOLATIONS, "none")
    topic: str = text()


class JointTrajectoryController(ControlledJoints, ModelPlugin):
    """Follows a `JointTrajectory` with the sum of a PID on position, a PID on velocity, and the efforts of the points.

    The target is the first point whose time has not passed, because Gazebo does not interpolate. A field that is
    missing in a point does not change the target. After the end, the last point remains the target. A new message
    replaces the active trajectory. A trajectory starts in the step after its message, or with `<use_header_start_time>`
    at the time in its header. At each change of the target, the fraction of started points is published on
    `<topic>_progress`.

    `<simkit:interpolation>` linear, cubic or quintic (`simkit.plugins.joints.joint_trajectory`) interpolates positions
    and velocities between the points instead.

    Without `<joint_name>`, all joints of the model with one axis are controlled. Each gain or limit is an element that
    is repeated once per joint, in the order of the joints. Each of them is also a live parameter, such as
    `<joint>.position_p_gain`.
    """

    endpoints = (
        listens("/model/{model}/joint_trajectory", TRAJECTORY, named_by=("topic",)),
        publishes("/model/{model}/joint_trajectory_progress", PROGRESS, named_by=("topic",)),
    )
    options = OptionsOf(JointTrajectoryControllerOptions)
    filenames = ("gz-sim-joint-trajectory-controller-system",)
    names = ("gz::sim::systems::JointTrajectoryController",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        chosen: list[SceneJoint] = []
        elements = params.all("joint_name")
        for element in elements:
            joint = find_joint(scene, element.value, element)
            if joint is None or not has_axis(joint, 0, element):
                continue
            if joint.type not in _ONE_AXIS or len(joint.axes) != 1:
                message = f"joint {joint.name!r} is {joint.type}; expected one of " + ", ".join(sorted(_ONE_AXIS))
                element.error("SK-PLUGIN-003", message)
            elif joint in chosen:
                message = f"plugin {self.name!r}: joint {joint.name!r} is listed twice; the first entry is used"
                params.diagnostics.warning("SK-PLUGIN-044", message, element.where, "remove one of the entries")
            else:
                chosen.append(joint)
        if not elements:
            chosen = [joint for joint in scene.joints if joint.type in _ONE_AXIS and len(joint.axes) == 1]
            if not chosen:
                message = f"plugin {self.name!r} needs a joint with one axis, and model {scene.scoped!r} has none"
                params.error("SK-PLUGIN-003", message)
        self._scoped = [joint.scoped for joint in chosen]

    @property
    def node(self) -> str:
        """Name of the ROS node that has the plugin's parameters, if the file does not name a node."""
        return valid_topic(f"/model/{self.scoped.replace('::', '/')}/joint_trajectory_controller")

    def load(self, parent: Model, params: Params) -> None:
        self._axes = self._read_axes(params)
        # Gazebo reads an attribute, but its manual describes an element
        attribute = self.options.use_header_start_time_attribute
        self._by_header = params.boolean("use_header_start_time", attribute.lower() in ("true", "1"))
        self._rule = cast("Interpolation", self.options.interpolation)
        topic = valid_topic(self.options.topic or f"/model/{parent.name}/joint_trajectory")
        self.listen(topic, TRAJECTORY, self._on_trajectory)
        self._progress = self.advertise(f"{topic}_progress", PROGRESS)
        self._is_ready = False
        self._message: tuple[list[str], list[TrajectoryPoint], int] | None = None
        self._names: list[str] = []
        self._points: list[TrajectoryPoint] = []
        self._times: list[int] = []
        self._start, self._index = 0, -1

    def _read_axes(self, params: Params) -> dict[str, _Axis]:
        """Return every joint with its controllers, by name."""
        count = len(self._scoped)
        table = {
            f"{kind}_{name}": self._repeated(params, f"{kind}_{name}", _DEFAULTS.get(name, 0.0))
            for kind in ("position", "velocity")
            for name in FIELDS
        }
        starts = self._repeated(params, "initial_position", 0.0)
        axes: dict[str, _Axis] = {}
        for i in range(count):
            joint = JointAxis(self.sim.joint(self._scoped[i]))
            by_position, by_velocity = (
                Pid.of({name: table[f"{kind}_{name}"][i] for name in FIELDS}) for kind in ("position", "velocity")
            )
            name = self._scoped[i].removeprefix(f"{self.scoped}::")
            axes[name] = _Axis(joint, by_position, by_velocity, starts[i])
        for name, axis in axes.items():
            declare_pid(self, axis.position_pid, partial(self._pid_of, name, "position_pid"), f"{name}.position_")
            declare_pid(self, axis.velocity_pid, partial(self._pid_of, name, "velocity_pid"), f"{name}.velocity_")
        return axes

    def _pid_of(self, joint: str, kind: str) -> Pid:
        pid: Pid = getattr(self._axes[joint], kind)
        return pid

    def _repeated(self, params: Params, element: str, default: float) -> list[float]:
        """Return one number per joint: the values of the repeated element in order, and then the default."""
        values: tuple[float, ...] = getattr(self.options, element)
        count = len(self._scoped)
        if len(values) > count:
            message = f"plugin {self.name!r} has {len(values)} <{element}> for {count} joint{'s'[: count != 1]}"
            hint = "use one for each joint, in the order of <joint_name>; surplus values have no effect"
            params.diagnostics.warning("SK-PLUGIN-044", message, params.all(element)[count].where, hint)
        return [*values, *[default] * count][:count]

    def controllers(self) -> list[tuple[JointAxis, Pid]]:
        pairs = [(a.joint, pid) for a in self._axes.values() for pid in (a.position_pid, a.velocity_pid)]
        return [(joint, pid) for joint, pid in pairs if pid.p or pid.i or pid.d]

    # ------------------------------------------------------------------ commands

    def _on_trajectory(self, message: msgs.JointTrajectory) -> None:
        names, points = [str(name) for name in message.joint_names], read_points(message)
        fault = trajectory_faults(names, points) if names else "it names no joints"
        if fault:
            self._once.left_out(fault, f"a trajectory is ignored: {fault}")
            return
        for name in names:
            if name not in self._axes:
                message_text = f"a trajectory contains joint {name!r}, which is not controlled; that part is ignored"
                self._once.left_out(name, message_text, suggest_names(name, list(self._axes)))
        if any(point.accelerations for point in points) and self._rule != "quintic":
            hint = "set <simkit:interpolation>quintic</simkit:interpolation> to use them"
            self._once.warn("SK-PLUGIN-045", "accelerations", "accelerations of a trajectory are not used", hint)
        start = nanoseconds(message.header.stamp) if self._by_header else 0
        self._message = names, points, start

    def _begin(self, now: int) -> None:
        """Start the trajectory of the last message."""
        assert self._message is not None
        self._names, self._points, start = self._message
        self._message = None
        self._times = [point.time for point in self._points]
        self._start, self._index = start or now, -1
        for axis in self._axes.values():
            axis.path = None
        if self._rule == "none":
            return
        for index, name in enumerate(self._names):
            controlled = self._axes.get(name)
            if controlled is not None:
                state = JointTarget(controlled.joint.position, controlled.joint.velocity)
                controlled.path = JointPath.through(state, self._points, index, self._rule)

    def _follow(self, now: int) -> None:
        """Set the targets for a simulated time [ns]."""
        since = now - self._start
        if not self._points or since < 0:
            return
        index = active_point(self._times, since)
        if index != self._index:
            self._index = index
            point = self._points[index]
            for joint, name in enumerate(self._names):
                axis = self._axes.get(name)
                if axis is None:
                    continue
                for field, values in _read_targets(point):
                    if joint < len(values):
                        setattr(axis, field, values[joint])
            if self._progress.wanted:
                self._progress.publish(msgs.type_of(PROGRESS)((index + 1) / len(self._points)))
        for axis in self._axes.values():
            if axis.path is not None:
                state = axis.path.at(since)
                axis.position, axis.velocity = state.position, state.velocity

    def before_step(self) -> None:
        now = self.sim.time_ns
        if self._message is not None:
            self._begin(now)
        self._follow(now)
        if not self._is_ready:  # in Gazebo the joints' state is not available in the first step
            self._is_ready = True
            return
        step = self.period
        for axis in self._axes.values():
            joint = axis.joint
            by_position = axis.position_pid.update(joint.position - axis.position, step)
            by_velocity = axis.velocity_pid.update(joint.velocity - axis.velocity, step)
            joint.push(by_position + by_velocity + axis.effort)
            for pid in (axis.position_pid, axis.velocity_pid):
                if pid.swings.is_unstable:
                    self.watch(joint, pid)


def _read_targets(point: TrajectoryPoint) -> tuple[tuple[str, tuple[float, ...]], ...]:
    return ("position", point.positions), ("velocity", point.velocities), ("effort", point.efforts)
