"""PR2's controller manager in Gazebo Classic: `libgazebo_ros_controller_manager.so`.

The parameters, the global namespace and the joint states are those of `gazebo_ros_controller_manager.cpp` in
pr2_simulator and of `controller_manager.cpp` in pr2_mechanism. Two differences are deliberate. A joint without a
controller holds its position; PR2's joints are free until their controllers start. The services have the types of
ROS 2's controller manager.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

from simkit.extend import Where
from simkit.plugins.ros_parameter_files import Entry
from simkit_control.plugins.ros2_control.control_plugin import GazeboRosControl
from simkit_control.plugins.ros2_control.controller_manager import ControllerManager
from simkit_control.plugins.ros2_control.hardware_description import (
    MOTION_INTERFACES,
    ComponentDescription,
    JointDescription,
)

if TYPE_CHECKING:
    from simkit import Params
    from simkit.extend import SceneModel

_JOINT_STATES: Final = "joint_states"
_JOINT_STATES_TYPE: Final = "pr2_controller_manager/JointStates"


class Pr2ControllerManager(ControllerManager):
    """Manager that publishes the joint states itself."""

    def declarations(self) -> dict[str, Entry]:
        return {_JOINT_STATES: Entry(Where(), _JOINT_STATES_TYPE), **super().declarations()}


class Pr2ControlPlugin(GazeboRosControl):
    """Runs the controllers that parameter files declare with PR2's types, on the joints of PR2's transmissions.

    `joint_states` is published at 100 Hz. A controller of `robot_mechanism_controllers` is the controller of ROS 1 with
    the same parameters: positions, velocities, efforts and trajectories of joints.
    """

    filenames = ("libgazebo_ros_controller_manager.so",)

    manager_class: ClassVar[type[ControllerManager]] = Pr2ControllerManager

    def _default_to_model_namespace(self, model: str, params: Params) -> None:
        """Keep the global namespace, which PR2's topics have."""

    def mark_ignored_elements(self, params: Params) -> None:
        for name in ("alwaysOn", "updateRate", "robotParam"):
            params.child(name)

    def describe_joints(self, scene: SceneModel, params: Params) -> list[ComponentDescription]:
        """Return the joints of the transmissions, with all interfaces; the passive ones have only states."""
        joints = {joint.name for joint in scene.all_joints() if len(joint.axes) == 1}
        found: dict[str, JointDescription] = {}
        for transmission in scene.transmissions:
            for end in transmission.joints:
                found[end.name] = JointDescription(end.name, MOTION_INTERFACES, MOTION_INTERFACES, transmission.where)
            for passive in transmission.params.all("passive_joint"):
                name = passive.attribute("name")
                found.setdefault(name, JointDescription(name, (), MOTION_INTERFACES, transmission.where))
        used = tuple(joint for name, joint in found.items() if name in joints)
        if not used:
            message = f"model {scene.scoped!r} has no <transmission> with a joint: no joint can be commanded"
            params.warning("SK-CONTROL-008", message, "add a <transmission> of pr2_mechanism_model for each joint")
        return [ComponentDescription(scene.name, "system", "pr2_mechanism_model", used)]
