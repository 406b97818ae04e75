"""gz's velocity control of joints: `gz::sim::systems::JointController`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np

from simkit.msgs.topics import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.lookups import find_axis_joint
from simkit.plugins.pid import Pid

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.pose import Vector
    from simkit.scene import SceneModel

DOUBLE: Final = "std_msgs/msg/Float64"
ACTUATORS: Final = "actuator_msgs/msg/Actuators"


class JointController(ModelPlugin):
    """Turns one or more joints at a commanded velocity [rad/s or m/s].

    By velocity: the efforts, within their limits, that bring the joints to it within one step. With
    `<use_force_commands>`: a PID on the velocity of the first joint gives the effort of all; `<disable_braking>` leaves
    out what would slow them down. Commands come on `/model/<model>/joint/<joint>/cmd_vel`, or as one of many actuators.
    """

    filenames = ("gz-sim-joint-controller-system",)
    drives = True
    names = ("gz::sim::systems::JointController",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        if not params.all("joint_name"):
            params.text("joint_name", required=True)
        found = [find_axis_joint(scene, element.value, params) for element in params.all("joint_name")]
        self._scoped = [joint.scoped for joint in found if joint is not None]
        self._first = found[0].name if found and found[0] is not None else ""

    def load(self, parent: Any, params: Params) -> None:
        self._joints = [self.sim.joint(name) for name in self._scoped]
        self._target = params.number("initial_velocity", 0.0)
        self._by_force = params.boolean("use_force_commands", False)
        self._coasts = params.boolean("disable_braking", False)
        self._pid = Pid.from_params(params, 1.0, 0.0, 0.0)
        self._number = params.integer("actuator_number", 0) if params.boolean("use_actuator_msg", False) else -1
        own = f"/model/{parent.name}"
        topic = "/actuators" if self._number >= 0 else f"{own}/joint/{self._first}/cmd_vel"
        inner = params.text("sub_topic", "")
        topic = params.text("topic", f"{own}/{inner}" if inner else topic)
        if self._number >= 0:
            self.listen(valid_topic(topic), ACTUATORS, self._on_actuators)
        else:
            self.listen(valid_topic(topic), DOUBLE, self._on_command)

    def _on_command(self, message: Any) -> None:
        self._aim(float(message.data))

    def _on_actuators(self, message: Any) -> None:
        if self._number < len(message.velocity):
            self._aim(float(message.velocity[self._number]))

    def _aim(self, velocity: float) -> None:
        if math.isfinite(velocity):
            self._target = velocity
        else:
            self.log.warning("%s: a command that is not finite is left out", self.name)

    def before_step(self) -> None:
        if not self._joints:
            return
        if not self._by_force:
            for joint, effort in zip(self._joints, efforts_for(self.sim, self._joints, self._target), strict=True):
                joint.set_effort(float(effort))
            return
        error = float(self._joints[0].velocity) - self._target
        effort = self._pid.update(error, self.period)
        if self._coasts and math.copysign(1.0, self._target) * error > 0.0:
            return
        for joint in self._joints:
            joint.set_effort(effort)


def efforts_for(sim: Any, joints: list[Any], velocity: float) -> Vector:
    """Efforts that bring joints of one degree of freedom to a velocity within one step, contacts aside.

    Of the acceleration without them, a, and the inverse inertia W at these joints: W τ = (velocity − q') / step − a.
    A velocity limit of a joint bounds its target.
    """
    model, data = sim.mj_model, sim.physics.fresh()
    dofs = [joint.mj_dofs[0] for joint in joints]
    units, solved = np.zeros((len(dofs), model.nv)), np.zeros((len(dofs), model.nv))
    units[range(len(dofs)), dofs] = 1.0
    mujoco.mj_solveM(model, data, solved, units)
    # damping is integrated implicitly: it adds to the inertia
    mobility = np.linalg.inv(solved[:, dofs]) + sim.timestep * np.diag(model.dof_damping[dofs])
    limits = np.array([float(joint.velocity_limit) for joint in joints])
    wanted = (np.clip(velocity, -limits, limits) - data.qvel[dofs]) / sim.timestep - data.qacc[dofs]
    efforts: Vector = mobility @ wanted
    return efforts
