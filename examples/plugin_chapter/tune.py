"""Step 5: a controller that takes commands from a topic, and whose gains can be changed while it runs.

simkit run tune.sdf --plugin-path . --duration 5
"""

from __future__ import annotations

from typing import Any

from simkit import Model, ModelPlugin, Params, msgs


class ArmTuner(ModelPlugin):
    """Turns `<joint>` to the angle [rad] that comes on `<topic>`; says on `angle` where it stands, 100 times a second.

    The effort is p·(wanted - angle) - d·velocity. `p_gain` [N·m/rad] and `d_gain` [N·m·s/rad] are live parameters.
    """

    filenames = ("libarm_tuner.so",)
    after_step_rate = 100.0

    def load(self, parent: Model, params: Params) -> None:
        self.joint = parent.joint(params.text("joint", required=True))
        self.wanted = params.number("angle", 0.0)
        self.p_gain = self.declare("p_gain", 5.0, minimum=0, description="stiffness [N·m/rad]")
        self.d_gain = self.declare("d_gain", 1.0, minimum=0, description="damping [N·m·s/rad]")
        self.listen(params.text("topic", "angle/set"), "std_msgs/msg/Float64", self.turn)
        self.angle = self.advertise("angle", "std_msgs/msg/Float64")

    def turn(self, message: Any) -> None:
        self.wanted = float(message.data)

    def before_step(self) -> None:
        error = self.wanted - self.joint.position
        self.joint.set_effort(self.p_gain.value * error - self.d_gain.value * self.joint.velocity)

    def after_step(self) -> None:
        self.angle.publish(msgs.make("std_msgs/msg/Float64", data=self.joint.position))
