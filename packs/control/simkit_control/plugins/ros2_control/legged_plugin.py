"""Hardware of legged_control in Gazebo Classic: `liblegged_hw_sim.so`.

The joints and the formula of the effort are those of `LeggedHWSim.cpp`. Its delay of commands (`gazebo/delay`) and its
interfaces of IMUs and contacts, which only its own controllers read, are left out.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from simkit_control.plugins.ros2_control.control_plugin import GazeboRosControl
from simkit_control.plugins.ros2_control.hardware_description import (
    GAIN_INTERFACES,
    MOTION_INTERFACES,
    ComponentDescription,
    JointDescription,
)
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT

if TYPE_CHECKING:
    from simkit import Params
    from simkit.extend import SceneModel, SpecBuilder


class LeggedControl(GazeboRosControl):
    """Runs the controllers that parameter files declare; joints with an effort interface have commanded gains too.

    The effort is `effort` + `kp` (`position` − x) + `kd` (`velocity` − v). A joint without a controller is free.
    """

    filenames = ("liblegged_hw_sim.so",)
    set_without_effort = frozenset()

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        self.hardware.forgets_commands = True

    def describe_joints(self, scene: SceneModel, params: Params) -> list[ComponentDescription]:
        return [replace(c, joints=tuple(map(_with_gains, c.joints))) for c in super().describe_joints(scene, params)]


def _with_gains(joint: JointDescription) -> JointDescription:
    """Return a joint whose effort interface is extended by positions, velocities and gains."""
    return replace(joint, commands=(*MOTION_INTERFACES, *GAIN_INTERFACES)) if EFFORT in joint.commands else joint
