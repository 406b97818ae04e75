"""Fetch's plugin `libfetch_gazebo_plugin.so`: the controller manager of `robot_controllers`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

from simkit.extend import Where
from simkit.plugins.ros_parameter_files import Entry
from simkit_control.plugins.ros2_control.control_plugin import GazeboRosControl
from simkit_control.plugins.ros2_control.controller_manager import ControllerManager
from simkit_control.plugins.ros2_control.robot_controller import RobotController

if TYPE_CHECKING:
    from simkit import Params

_JOINT_STATES: Final = "joint_states"
_JOINT_STATES_TYPE: Final = "fetch_gazebo/JointStates"


class RobotControllerManager(ControllerManager):
    """Manager whose controllers are listed in `gazebo/default_controllers`, and which start with a goal."""

    def declarations(self) -> dict[str, Entry]:
        of_node = self.files.of_node(f"{self.namespace}/gazebo")
        listed = (of_node.below or {}).get("default_controllers") if of_node is not None else None
        declared = {}
        for item in (listed.items or ()) if listed is not None else ():
            entry = self.files.of_node(f"{self.namespace}/{item.text}")
            kind = (entry.below or {}).get("type") if entry is not None else None
            declared[item.text] = kind if kind is not None else Entry(item.where)
        if declared:
            declared[_JOINT_STATES] = Entry(Where(), _JOINT_STATES_TYPE)
        return declared

    def start_configured(self, name: str) -> None:
        controller = self.controllers[name].controller
        if not isinstance(controller, RobotController) or controller.autostart:
            super().start_configured(name)

    def request_start(self, name: str) -> bool:
        """Activate a controller, and deactivate the controllers of its joints, unless one of them has a goal."""
        loaded = self.controllers[name]
        if loaded.state == "active":
            return True
        owners = dict.fromkeys(self.conflicts(name).values())
        others = [self.controllers[owner].controller for owner in owners]
        if any(isinstance(other, RobotController) and other.has_goal for other in others):
            return False
        return not self.switch([name], list(owners), strict=True)


class FetchGazeboPlugin(GazeboRosControl):
    """Runs the controllers that `gazebo/default_controllers` lists in parameter files in ROS 1's layout."""

    filenames = ("libfetch_gazebo_plugin.so",)

    manager_class: ClassVar[type[ControllerManager]] = RobotControllerManager

    def _default_to_model_namespace(self, model: str, params: Params) -> None:
        """Keep the global namespace, which Fetch's topics have."""
