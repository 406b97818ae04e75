"""Joint controllers of Gazebo: `gz::sim::systems::JointController` and `gz::sim::systems::JointPositionController`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.endpoints import listens
from simkit.plugins.joints.joint_commands import ACTUATORS, DOUBLE, GAINS, JointCommander, JointCommandOptions
from simkit.plugins.joints.pid import Pid
from simkit.plugins.options import OptionsOf, boolean, integer, number

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.runtime.communication.parameter import Parameter
    from simkit.scene import SceneModel

_ACTUATORS = listens("/actuators", ACTUATORS, named_by=("topic", "sub_topic"))


class JointControllerOptions(JointCommandOptions):
    """Options of `JointController`."""

    initial_velocity: float = number(0.0, "rad/s or m/s")
    use_force_commands: bool = boolean()
    disable_braking: bool = boolean()


class JointController(JointCommander):
    """Moves the first axis of one or more joints at a commanded velocity [rad/s or m/s].

    By default the joints reach the velocity within one step, by efforts within their limits. With
    `<use_force_commands>`, a PID on the velocity of the first joint computes one effort for all joints;
    `<disable_braking>` then suppresses efforts that slow the joints down. Commands are read from
    `/model/<model>/joint/<joint>/cmd_vel`, from `<sub_topic>` below the model's topics, or from `<topic>`. With
    `<use_actuator_msg>` the command is number `<actuator_number>` in an `Actuators` message. The gains and limits of
    the PID are live parameters.
    """

    endpoints = (
        listens("/model/{model}/joint/{joint_name}/cmd_vel", DOUBLE, named_by=("topic", "sub_topic")),
        _ACTUATORS,
    )
    options = OptionsOf(JointControllerOptions)
    filenames = ("gz-sim-joint-controller-system",)
    names = ("gz::sim::systems::JointController",)
    actuator_field = "velocity"
    target_element = "initial_velocity"

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        self.own_topic = f"joint/{self._first_name}/cmd_vel"

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self._by_velocity = not self.options.use_force_commands
        self._coasts = self.options.disable_braking
        if self._by_velocity:
            self.warn_about_unused_gains(params, (*GAINS, "disable_braking"), "without <use_force_commands>")
        else:
            self.declare_controller(Pid(1.0, 0.0, 0.0, 1.0, -1.0, 1000.0, -1000.0))

    def command(self) -> None:
        if self._by_velocity:
            self.turn(self._target)
            return
        error = self.axes[0].velocity - self._target
        if self._coasts and (self._target == 0.0 or math.copysign(1.0, self._target) * error > 0.0):
            return
        self.push(error)


class JointPositionControllerOptions(JointCommandOptions):
    """Options of `JointPositionController`."""

    i_gain: float = number(0.1, is_live=True)
    d_gain: float = number(0.01, is_live=True)
    joint_index: int = integer(0, minimum=0)
    initial_position: float = number(0.0, "rad or m")
    use_velocity_commands: bool = boolean()


class JointPositionController(JointCommander):
    """Moves one or more joints to a commanded position [rad or m].

    A PID on the position of the first joint computes one effort for all joints. With `<use_velocity_commands>` the
    joints move instead at the velocity that reaches the position within one step; `<cmd_max>`, if present, limits this
    velocity. Commands are read from `/model/<model>/joint/<joint>/<joint_index>/cmd_pos`, from `<sub_topic>` below the
    model's topics, or from `<topic>`. With `<use_actuator_msg>` the command is number `<actuator_number>` in an
    `Actuators` message. The first target is `<initial_position>`. `<joint_index>` selects the axis of a joint with
    several axes. The gains and limits of the PID are live parameters.
    """

    endpoints = (
        listens("/model/{model}/joint/{joint_name}/{joint_index}/cmd_pos", DOUBLE, named_by=("topic", "sub_topic")),
        _ACTUATORS,
    )
    options = OptionsOf(JointPositionControllerOptions)
    filenames = ("gz-sim-joint-position-controller-system",)
    names = ("gz::sim::systems::JointPositionController",)
    actuator_field = "position"
    target_element = "initial_position"

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._index = self.options.joint_index
        super().prepare(scene, params, builder)
        self.own_topic = f"joint/{self._first_name}/{self._index}/cmd_pos"

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self._by_velocity = self.options.use_velocity_commands
        self._fastest: Parameter[float] | None = None
        if not self._by_velocity:
            self.declare_controller(Pid(1.0, 0.1, 0.01, 1.0, -1.0, 1000.0, -1000.0))
            return
        if params.has("cmd_max"):
            description = "largest velocity [rad/s or m/s]"
            self._fastest = self.declare("cmd_max", 1000.0, minimum=0.0, description=description)
        unused = tuple(name for name in GAINS if name != "cmd_max")
        self.warn_about_unused_gains(params, unused, "with <use_velocity_commands>")

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
