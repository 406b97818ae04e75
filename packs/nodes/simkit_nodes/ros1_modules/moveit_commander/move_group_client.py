"""Client of the services and actions of `move_group`, and descriptions of its robot."""

from __future__ import annotations

from typing import Any, Final

from simkit_nodes.interfaces import ROS1, ProgramMessage, interface_module
from simkit_nodes.interfaces.interface_classes import ros1_service
from simkit_nodes.robot_groups import DescriptionError, JointGroup, RobotGroups, read_robot_groups
from simkit_nodes.ros1_modules.actionlib.simple_action_client import SimpleActionClient
from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.rospy.client import get_param, has_param, search_param, wait_for_message
from simkit_nodes.ros1_modules.rospy.exceptions import ROSException, ROSInterruptException
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import Time
from simkit_nodes.ros1_modules.rospy.service import ServiceProxy, wait_for_service
from simkit_nodes.ros1_names import ns_join

__all__: list[str] = []

_ACTIONS: Final = ("move_group", "move_action")
"""Names of the action that plans and moves: those of ROS 1 and of ROS 2."""
_PATIENCE: Final = 5.0  # [s], for descriptions and services
_MESSAGES: Final = interface_module("moveit_msgs.msg", ROS1)
_ALL_COMPONENTS: Final = 1023  # of moveit_msgs/PlanningSceneComponents


def new_message(name: str) -> ProgramMessage:
    """Return a new message of a type such as `moveit_msgs/RobotState`."""
    package, _, short = name.partition("/")
    return ROS1.message_class(f"{package}/msg/{short}")()


def action_message(name: str) -> ProgramMessage:
    """Return a new message of an action of MoveIt, such as `MoveGroupGoal`."""
    return getattr(_MESSAGES, name)()


class MoveGroupServices:
    """Services of `move_group`.

    Args:
        namespace: namespace of `move_group`; empty for that of the program.
    """

    def __init__(self, namespace: str) -> None:
        self._namespace = namespace
        self._proxies: dict[str, ServiceProxy] = {}

    def name(self, name: str) -> str:
        """Return the name of a topic, service or action of `move_group`."""
        return ns_join(self._namespace, name)

    def call(self, name: str, kind: str, request: ProgramMessage) -> Any:
        """Call a service and return its response.

        Args:
            name: name of the service.
            kind: type of the service, such as `GetPositionFK`.
            request: request.

        Raises:
            MoveItCommanderException: there is no such service.
        """
        full = self.name(name)
        if full not in self._proxies:
            try:
                wait_for_service(full, _PATIENCE)
            except ROSInterruptException:
                raise
            except ROSException:
                text = f"there is no service {full} after {_PATIENCE:g} s; start move_group, and spawn the robot"
                raise MoveItCommanderException(text) from None
            self._proxies[full] = ServiceProxy(full, ros1_service(f"moveit_msgs/srv/{kind}"))
        return self._proxies[full](request)

    def request(self, kind: str) -> ProgramMessage:
        """Return a new request of a service type such as `GetPositionFK`."""
        return ROS1.message_class(f"moveit_msgs/srv/{kind}_Request")()

    def scene(self, components: int = _ALL_COMPONENTS) -> Any:
        """Return the planning scene, a `moveit_msgs/PlanningScene`."""
        request = self.request("GetPlanningScene")
        request.components.components = components
        return self.call("get_planning_scene", "GetPlanningScene", request).scene

    def apply(self, scene: ProgramMessage) -> bool:
        """Change the planning scene by a `moveit_msgs/PlanningScene`; return True on success."""
        request = self.request("ApplyPlanningScene")
        request.scene = scene
        return bool(self.call("apply_planning_scene", "ApplyPlanningScene", request).success)

    def apply_attached(self, attached: ProgramMessage) -> bool:
        """Change the planning scene by a `moveit_msgs/AttachedCollisionObject`; return True on success."""
        scene = new_message("moveit_msgs/PlanningScene")
        scene.is_diff = scene.robot_state.is_diff = True
        scene.robot_state.attached_collision_objects = [attached]
        return self.apply(scene)


class MoveGroupClient(MoveGroupServices):
    """Client of `move_group` that knows the robot.

    Args:
        description: name of the parameter with the robot's description.
        namespace: namespace of `move_group`; empty for that of the program.

    Attributes:
        groups: groups of the robot.

    Raises:
        RuntimeError: there are no descriptions of the robot, or they are not valid.
    """

    def __init__(self, description: str, namespace: str) -> None:
        super().__init__(namespace)
        urdf, srdf = self._text(description), self._text(f"{description}_semantic")
        try:
            self.groups: RobotGroups = read_robot_groups(urdf, srdf)
        except DescriptionError as error:
            raise RuntimeError(f"Unable to construct robot model: {error}") from None

    def _text(self, name: str) -> str:
        """Return a description: the parameter, or the last message of a topic with its name."""
        full = self.name(name)
        found = full if has_param(full) else search_param(name)
        if found is not None and has_param(found):
            return str(get_param(found))
        try:
            return str(wait_for_message(full, ROS1.message_class("std_msgs/msg/String"), _PATIENCE).data)
        except ROSInterruptException:
            raise
        except ROSException:
            text = f"Unable to construct robot model: neither a parameter nor a topic is named {name}"
            raise RuntimeError(f"{text}; start move_group, or load the parameter") from None

    def group(self, name: str) -> JointGroup:
        """Return a group.

        Raises:
            RuntimeError: there is no such group.
        """
        if name not in self.groups.groups:
            known = ", ".join(self.groups.groups) or "none"
            raise RuntimeError(f"Group '{name}' was not found; the robot has {known}")
        return self.groups.groups[name]

    def move_client(self, patience: float) -> SimpleActionClient:
        """Return the client of the action that plans and moves.

        Args:
            patience: longest wait for the action [s]; 0 for no limit.

        Raises:
            RuntimeError: the action does not exist in time.
        """
        node = ros_node()
        names = {node.resolve_endpoint(self.name(name)): name for name in _ACTIONS}

        def found() -> list[str]:
            return [short for full, short in names.items() if full in node.host.graph.actions()]

        limit = node.host.now_ns() + round(patience * 1e9) if patience > 0 else None
        node.wait(limit, lambda: bool(found()))
        if not found():
            text = f"Unable to connect to move_group action server '{self.name('move_group')}' within {patience:g} s"
            raise RuntimeError(f"{text}; start move_group, and spawn the robot")
        return self._connected(found()[0], "MoveGroupAction")

    def execution_client(self) -> SimpleActionClient:
        """Return the client of the action that executes trajectories."""
        return self._connected("execute_trajectory", "ExecuteTrajectoryAction")

    def _connected(self, name: str, kind: str) -> SimpleActionClient:
        client = SimpleActionClient(self.name(name), getattr(_MESSAGES, kind))
        client.wait_for_server()
        return client

    # ------------------------------------------------------------------ state

    def state(self) -> Any:
        """Return the state of the robot, a `moveit_msgs/RobotState`."""
        state = self.scene().robot_state
        state.joint_state.header.frame_id, state.joint_state.header.stamp = self.groups.planning_frame, Time.now()
        return state

    def positions(self) -> dict[str, float]:
        """Return the positions of the joints [rad or m]."""
        state = self.scene().robot_state.joint_state
        return dict(zip(state.name, state.position, strict=True))

    def pose(self, link: str, state: ProgramMessage | None = None) -> ProgramMessage:
        """Return the pose of a link in the planning frame, a `geometry_msgs/PoseStamped`.

        Args:
            link: name of the link.
            state: positions of joints, a `moveit_msgs/RobotState`; the others have their present ones.

        Raises:
            MoveItCommanderException: there is no such link.
        """
        request = self.request("GetPositionFK")
        if state is not None:
            request.robot_state = state
        request.header.frame_id, request.fk_link_names = self.groups.planning_frame, [link]
        response = self.call("compute_fk", "GetPositionFK", request)
        if response.error_code.val != 1:
            raise MoveItCommanderException(f"there is no pose of {link}: {response.error_code.message}")
        return response.pose_stamped[0]
