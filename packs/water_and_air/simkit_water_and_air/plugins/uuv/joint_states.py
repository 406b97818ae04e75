"""Joint states of an underwater vehicle: `libuuv_joint_state_publisher.so` of uuv_simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import Params
from simkit.extend import Options, OptionsOf, number, publishes, text
from simkit.plugins.joint_states import JOINT_STATE, JointStates

if TYPE_CHECKING:
    from simkit.extend import SceneModel, SpecBuilder


class UuvJointStatesOptions(Options):
    """Options of `UuvJointStates`."""

    namespace: str = text(element="robotNamespace")
    rate: float = number(50.0, "Hz", element="updateRate", minimum=1e-9)


class UuvJointStates(JointStates):
    """Publishes the states of all joints of the model on `/<robotNamespace>/joint_states` (the model's name)."""

    endpoints = (publishes("/{model}/joint_states", JOINT_STATE, named_by=("robotNamespace",)),)
    options = OptionsOf(UuvJointStatesOptions)
    filenames = ("libuuv_joint_state_publisher.so",)
    only_publishes = True
    array_rule = JointStates.array_rule

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options
        self.joint_names = [joint.scoped for joint in scene.all_joints()]
        self._topic = f"/{(options.namespace or scene.name).strip('/')}/joint_states"
        self.after_step_rate = options.rate
