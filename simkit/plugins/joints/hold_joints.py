"""Servos that hold the joints that no plugin drives, for robots without controllers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit.plugins.base import WorldPlugin

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.params import Params
    from simkit.runtime import Simulation
    from simkit.scene import SceneWorld

_TYPES: Final = ("revolute", "continuous", "prismatic")


class HoldJoints(WorldPlugin):
    """Holds each joint that no plugin drives at its initial position, with the effort limit of the joint.

    Files of robots often have no controllers: another program sends efforts to the joints. Without it, the robot folds,
    in Gazebo too. The option `--hold-joints` adds this plugin. Followers (`<mimic>`) and static models have no servo.
    """

    drives = True

    def prepare(self, scene: SceneWorld, params: Params, builder: SpecBuilder) -> None:
        driven = {(ref.joint, ref.axis) for record in builder.records.values() for ref in record.actuators}
        self._servos = [
            builder.add_position_servo(joint.scoped, max_effort=math.inf, owner=type(self).__name__)
            for joint in builder.names.joints.values()
            if joint.type in _TYPES and joint.scene.axes[0].mimic is None and joint.joint_names
            if (joint.scoped, 0) not in driven
        ]

    def load(self, parent: Simulation, params: Params) -> None:
        for servo in self._servos:
            self.sim.engine.set_control(servo, float(self.sim.joint(servo.joint).position))
