"""Base class of Gazebo's systems that command joints: names, topics, targets and reports."""

from __future__ import annotations

import abc
from typing import TYPE_CHECKING, ClassVar, Final

from simkit.msgs.topic_names import valid_topic
from simkit.number_text import counted
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.joints.joint_axis import JointAxis, find_joints
from simkit.plugins.joints.kinematic_trees import KinematicTrees
from simkit.plugins.joints.pid import FIELDS, Pid, PidOptions, declare_pid
from simkit.plugins.joints.velocity_servo import VelocityServo
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.one_time_warnings import OneTimeWarnings, are_usable
from simkit.plugins.options import OptionsOf, boolean, integer, text, texts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from simkit.compiler import SpecBuilder
    from simkit.diagnostics import Where
    from simkit.msgs import Actuators, Float64
    from simkit.runtime import Model
    from simkit.scene import SceneModel

DOUBLE: Final = "std_msgs/msg/Float64"
ACTUATORS: Final = "actuator_msgs/msg/Actuators"


class ControlledJoints:
    """Mixin of plugins with PID controllers: lists the driven joints, and reports an unstable controller."""

    name: str
    where: Where
    _once: OneTimeWarnings

    def controllers(self) -> list[tuple[JointAxis, Pid]]:
        """Return the driven joint axes with their controllers."""
        return []

    def watch(self, axis: JointAxis, pid: Pid) -> None:
        """Warn once about an unstable controller."""
        if pid.swings.is_unstable:
            message = (
                f"the PID of joint {axis.joint.scoped!r} is unstable: its error oscillates with growing amplitude or "
                f"between both effort limits (p_gain {pid.p:g}, i_gain {pid.i:g}, d_gain {pid.d:g})"
            )
            hint = "use smaller gains or a smaller max_step_size, or add damping to the joint"
            self._once.warn("SK-PLUGIN-040", f"unstable {axis.joint.scoped}", message, hint)

    def explain_divergence(self, name: str) -> str:
        """Describe the effect of this plugin on a joint whose physics diverged.

        Args:
            name: Scoped name of a joint, or of a top-level model. For a model, the joint with the largest effort is
                described.

        Returns:
            A sentence, or an empty text if the plugin drives no such joint.
        """
        matching = [pair for pair in self.controllers() if pair[0].is_meant(name)]
        if not matching:
            return ""
        matching.sort(key=lambda pair: -abs(pair[1].command))
        axis, pid = matching[0]
        gains = f"p_gain {pid.p:g}, i_gain {pid.i:g}, d_gain {pid.d:g}"
        return (
            f"plugin {self.name!r} ({self.where}) drives joint {axis.joint.scoped!r} by a PID ({gains}); "
            f"its last error was {-pid.last:g}, its last effort {pid.command:g}"
        )


class JointCommandOptions(PidOptions):
    """Options shared by all systems that command joints."""

    joint_names: tuple[str, ...] = texts(element="joint_name", required=True)
    use_actuator_msg: bool = boolean()
    actuator_number: int = integer(0, minimum=0)
    sub_topic: str = text()
    topic: str = text()


class JointCommander(ControlledJoints, ModelPlugin):
    """Base class of systems that move joints to a commanded value; one controller acts on the first joint's error.

    In Gazebo the joint's state is not available in the first step, so commands act from the second step on.

    Attributes:
        own_topic: Default topic, below the model's topics.
        actuator_field: Field of an `Actuators` message that holds the commands.
        target_element: Element that holds the first target.
    """

    options = OptionsOf(JointCommandOptions)
    drives = True
    own_topic: str = ""
    actuator_field: ClassVar[str]
    target_element: ClassVar[str]
    _by_velocity: bool = False
    _index: int = 0

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        faults = params.diagnostics.error_count
        joints = find_joints(scene, params, axis=self._index)
        if params.diagnostics.error_count > faults:  # the plugin will not be loaded, so report all other errors now
            for element in FIELDS:
                params.number(element)
        self._scoped = [joint.scoped for joint in joints]
        self._first_name = next((e.value for e in params.all("joint_name") if e.value), "")

    def load(self, parent: Model, params: Params) -> None:
        self.axes = [JointAxis(self.sim.joint(name), self._index) for name in self._scoped]
        self._target = params.number(self.target_element, 0.0)
        self._is_ready = False
        self._pid: Pid | None = None
        self._servo = VelocityServo()
        self._commanded_velocity: float | None = None
        self._group: _VelocityGroup | None = None
        self._listen(parent, params)

    @property
    def node(self) -> str:
        """Default name of the ROS node that has the parameters: the joint's topic and the controller."""
        joint = f"/model/{self.scoped}/joint/{self._first_name}".replace("::", "/")
        axis = f"_{self._index}" if self._index else ""
        return valid_topic(f"{joint}/{self.actuator_field}_controller{axis}")

    def _listen(self, parent: Model, params: Params) -> None:
        """Subscribe to the command topic by Gazebo's rules: `<topic>`, else `<sub_topic>`, else the default."""
        self._number = -1
        if self.options.use_actuator_msg:
            if params.has("actuator_number"):
                self._number = self.options.actuator_number
            else:
                message = "<use_actuator_msg> needs <actuator_number>; commands are read from Float64 messages instead"
                self._once.warn("SK-PLUGIN-042", "number", message)
        else:
            _ = self.options.actuator_number
        model_topic = f"/model/{parent.name}"
        topic = "/actuators" if self._number >= 0 else f"{model_topic}/{self.own_topic}"
        inner = self.options.sub_topic
        topic = self.options.topic or (f"{model_topic}/{inner}" if inner else topic)
        if self._number >= 0:
            self.listen(valid_topic(topic), ACTUATORS, self._on_actuators)
        else:
            self.listen(valid_topic(topic), DOUBLE, self._on_command)

    def _on_command(self, message: Float64) -> None:
        self._aim(float(message.data))

    def _on_actuators(self, message: Actuators) -> None:
        values = getattr(message, self.actuator_field)
        if self._number < len(values):
            self._aim(float(values[self._number]))
        else:
            numbers = counted(len(values), "number")
            what = f"{self.actuator_field} of a message has {numbers} and none for actuator {self._number}"
            self._once.left_out("short", f"{what}; the message is ignored")

    def _aim(self, target: float) -> None:
        if are_usable(target):
            self._target = target
        else:
            self._once.left_out("finite", f"the command {target} is ignored; expected a finite number up to 1e10")

    def declare_controller(self, first: Pid) -> None:
        """Set the controller and declare its gains as live parameters.

        Args:
            first: Controller with the default gains, which the file can override.
        """

        def present() -> Pid:
            assert self._pid is not None
            return self._pid

        self._pid = declare_pid(self, first, present)

    def controllers(self) -> list[tuple[JointAxis, Pid]]:
        return [] if self._pid is None else [(axis, self._pid) for axis in self.axes]

    def explain_divergence(self, name: str) -> str:
        """Describe the velocity command of a joint that diverged, or else the controller, as in the base class."""
        axis = next((axis for axis in self.axes if axis.is_meant(name)), None)
        if axis is None or self._commanded_velocity is None:
            return super().explain_divergence(name)
        return f"plugin {self.name!r} ({self.where}) moves joint {axis.joint.scoped!r} at {self._commanded_velocity:g}"

    def before_step(self) -> None:
        self._commanded_velocity = None
        if self.axes and self._is_ready:
            self.command()
        self._is_ready = True
        if self._by_velocity:
            self._drive()

    @abc.abstractmethod
    def command(self) -> None:
        """Move the joints towards the target, with `push` or `turn`."""

    def push(self, error: float) -> None:
        """Push all joints with the effort that the controller returns for an error of the first joint."""
        assert self._pid is not None
        effort = self._pid.update(error, self.period)
        for axis in self.axes:
            axis.push(effort)
        if self._pid.swings.is_unstable:
            self.watch(self.axes[0], self._pid)

    def turn(self, velocity: float) -> None:
        """Command a velocity of all joints for the next step."""
        self._commanded_velocity = velocity

    def _drive(self) -> None:
        """Apply the velocities of all plugins together, because joints of one kinematic tree need a common solution.

        The last of these plugins in a step does this; the others do nothing.
        """
        group, structure = self._group, self.sim.engine.structure
        if group is None or group.structure is not structure:
            members = [p for p in structure.all_plugins() if isinstance(p, JointCommander) and p._by_velocity]
            group = self._group = _VelocityGroup(structure, members)
        is_disabled = self.sim.engine.faults.is_disabled
        if self is next(p for p in reversed(group.members) if not is_disabled(p)):
            pairs = [
                (axis, p._commanded_velocity)
                for p in group.members
                if p._commanded_velocity is not None and not is_disabled(p)
                for axis in p.axes
            ]
            if pairs:
                axes, velocities = zip(*pairs, strict=True)
                self._servo.drive(self.sim, axes, velocities, group.layouts)

    def warn_about_unused_gains(self, params: Params, unused: Sequence[str], reason: str) -> None:
        """Warn about gains in the file that have no effect.

        Args:
            params: Parameters of the plugin.
            unused: Names of the elements that may be present.
            reason: End of the message.
        """
        unused_elements = [name for name in unused if params.all(name)]
        if unused_elements:
            listed = ", ".join(f"<{name}>" for name in unused_elements)
            message = (
                f"plugin {self.name!r}: {listed} {'has' if len(unused_elements) == 1 else 'have'} no effect {reason}"
            )
            params.diagnostics.warning("SK-PLUGIN-043", message, self.where)


class _VelocityGroup(SharedByCopies):
    """Plugins of one simulation that command velocities, with the kinematic trees of their joints."""

    def __init__(self, structure: object, members: list[JointCommander]) -> None:
        self.structure, self.members = structure, members
        self.layouts: dict[tuple[int, ...], KinematicTrees] = {}


GAINS: Final = tuple(FIELDS)
