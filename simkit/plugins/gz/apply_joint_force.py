"""gz's efforts on joints: `gz::sim::systems::ApplyJointForce`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import listens
from simkit.plugins.joints.joint_axis import JointAxis, find_joints
from simkit.plugins.joints.joint_commands import DOUBLE
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import Options, OptionsOf, texts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Float64
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class ApplyJointForceOptions(Options):
    """Options of `ApplyJointForce`."""

    joint_name: tuple[str, ...] = texts(required=True)


class ApplyJointForce(ModelPlugin):
    """Pushes a joint about its first axis with the effort [N·m or N] of the last message, at every step.

    Commands come on `/model/<model>/joint/<joint>/cmd_force`. The effort adds to what plugins before it in the file
    have set for the step; what comes after it and sets an effort of its own takes its place, as in gz.
    """

    endpoints = (listens("/model/{model}/joint/{joint_name}/cmd_force", DOUBLE),)
    options = OptionsOf(ApplyJointForceOptions)
    filenames = ("gz-sim-apply-joint-force-system",)
    names = ("gz::sim::systems::ApplyJointForce",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        names = params.all("joint_name")
        for extra in names[1:]:
            message = f"plugin {self.name!r} takes one <joint_name>; {extra.value!r} is not used"
            params.diagnostics.warning("SK-PLUGIN-044", message, extra.where, "a plugin for each joint")
        found = find_joints(scene, params, most=1)
        self._scoped = found[0].scoped if found else ""
        self._written = names[0].value if names else ""

    def load(self, parent: Model, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        self._axis = JointAxis(self.sim.joint(self._scoped)) if self._scoped else None
        self._effort = 0.0
        self.listen(valid_topic(f"/model/{parent.name}/joint/{self._written}/cmd_force"), DOUBLE, self._on_command)

    def _on_command(self, message: Float64) -> None:
        effort = float(message.data)
        if math.isfinite(effort):
            self._effort = effort
        else:
            self.once.left_out("finite", f"the command {effort} is left out; allowed is a finite number")

    def explain_divergence(self, name: str) -> str:
        """What this plugin may have to do with the physics leaving the numbers; empty for nothing."""
        if not self._effort or self._axis is None or not self._axis.is_meant(name):
            return ""
        return f"plugin {self.name!r} ({self.where}) pushes joint {self._axis.joint.scoped!r} with {self._effort:g}"

    def before_step(self) -> None:
        if self._effort and self._axis is not None:
            self._axis.add(self._effort)
