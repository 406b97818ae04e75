"""gz's position control of joints: `gz::sim::systems::JointPositionController`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.endpoints import listens
from simkit.plugins.joints.joint_commands import GAINS, JointCommander, JointCommandOptions
from simkit.plugins.joints.pid import Pid, declare_pid
from simkit.plugins.options import OptionsOf, boolean, integer, number

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.runtime.communication.parameter_server import Parameter
    from simkit.scene import SceneModel


class JointPositionControllerOptions(JointCommandOptions):
    """Options of `JointPositionController`."""

    i_gain: float = number(0.1, is_live=True)
    d_gain: float = number(0.01, is_live=True)
    joint_index: int = integer(0, minimum=0)
    initial_position: float = number(0.0, "rad or m")
    use_velocity_commands: bool = boolean()


class JointPositionController(JointCommander):
    """Brings one or more joints to a commanded position [rad or m].

    A PID on the position of the first joint gives the effort of all. With `<use_velocity_commands>` they move instead
    at the velocity that reaches the position within one step, at most `<cmd_max>` where the file gives one. Commands
    come on `/model/<model>/joint/<joint>/<joint_index>/cmd_pos`, on `<sub_topic>` below the model or on `<topic>`, or
    as one of many actuators (`<use_actuator_msg>`, `<actuator_number>`); the first target is `<initial_position>`.
    `<joint_index>` is the axis of a joint that has several. The numbers of the PID are live parameters.
    """

    endpoints = (
        listens(
            "/model/{model}/joint/{joint_name}/{joint_index}/cmd_pos",
            "std_msgs/msg/Float64",
            named_by=("topic", "sub_topic"),
        ),
        listens("/actuators", "actuator_msgs/msg/Actuators", named_by=("topic", "sub_topic")),
    )
    options = OptionsOf(JointPositionControllerOptions)
    filenames = ("gz-sim-joint-position-controller-system",)
    names = ("gz::sim::systems::JointPositionController",)
    actuator_field = "position"
    target_element = "initial_position"

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._index = self.options.joint_index
        super().prepare(scene, params, builder)
        self.own_topic = f"joint/{self._first}/{self._index}/cmd_pos"

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self._by_velocity = self.options.use_velocity_commands
        self._fastest: Parameter[float] | None = None
        if not self._by_velocity:
            self._pid = declare_pid(self, Pid(1.0, 0.1, 0.01, 1.0, -1.0, 1000.0, -1000.0), self._present_pid)
            return
        if params.has("cmd_max"):
            says = "largest velocity [rad/s or m/s]"
            self._fastest = self.declare("cmd_max", 1000.0, minimum=0.0, description=says)
        unused = tuple(name for name in GAINS if name != "cmd_max")
        self.say_gains_are_unused(params, unused, "with <use_velocity_commands>")

    def _present_pid(self) -> Pid:
        assert self._pid is not None
        return self._pid

    def command(self) -> None:
        error = self.axes[0].position - self._target
        if not self._by_velocity:
            self.push(error)
            return
        velocity = -error / self.period
        if self._fastest is not None:
            most = self._fastest.value
            velocity = max(-most, min(most, velocity))
        self.turn(velocity)
