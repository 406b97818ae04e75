"""Launch descriptions of the parts of MoveIt."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.extend import Diagnostics
from simkit.loaders.resources.xml_reader import parse_text
from simkit_launch.launch_modules.launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from simkit_launch.launch_modules.launch.conditions import IfCondition
from simkit_launch.launch_modules.launch.launch_description import LaunchDescription
from simkit_launch.launch_modules.launch.substitutions import LaunchConfiguration
from simkit_launch.launch_modules.launch_ros.actions import Node
from simkit_launch.launch_modules.launch_ros.parameter_descriptions import ParameterValue
from simkit_launch.launch_modules.moveit_configs_utils.launch_utils import DeclareBooleanLaunchArg

if TYPE_CHECKING:
    from simkit_launch.launch_modules.moveit_configs_utils.moveit_configs_builder import MoveItConfigs

__all__ = [
    "generate_demo_launch",
    "generate_move_group_launch",
    "generate_moveit_rviz_launch",
    "generate_rsp_launch",
    "generate_setup_assistant_launch",
    "generate_spawn_controllers_launch",
    "generate_static_virtual_joint_tfs_launch",
    "generate_warehouse_db_launch",
]


def generate_rsp_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts the publisher of the robot's frames."""
    node = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        respawn=True,
        parameters=[moveit_config.robot_description, {"publish_frequency": LaunchConfiguration("publish_frequency")}],
    )
    return LaunchDescription([DeclareLaunchArgument("publish_frequency", default_value="15.0"), node])


def generate_moveit_rviz_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts the viewer."""
    file = str(_folder(moveit_config) / "config" / "moveit.rviz")
    node = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", LaunchConfiguration("rviz_config")],
        parameters=[
            moveit_config.planning_pipelines,
            moveit_config.robot_description_kinematics,
            moveit_config.joint_limits,
        ],
    )
    arguments = [DeclareBooleanLaunchArg("debug"), DeclareLaunchArgument("rviz_config", default_value=file)]
    return LaunchDescription([*arguments, node])


def generate_setup_assistant_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts the editor of the configuration package."""
    node = Node(
        package="moveit_setup_assistant",
        executable="moveit_setup_assistant",
        arguments=[f"--config_pkg={_folder(moveit_config)}"],
    )
    return LaunchDescription([DeclareBooleanLaunchArg("debug"), node])


def generate_static_virtual_joint_tfs_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts a publisher for the frame of each virtual joint."""
    texts = [text for text in moveit_config.robot_description_semantic.values() if isinstance(text, str) and text]
    nodes = []
    for text in texts:
        root = parse_text(text, Diagnostics())
        for number, joint in enumerate(() if root is None else root.all("virtual_joint")):
            frames = [joint.attribute("parent_frame", "world"), joint.attribute("child_link", "base_link")]
            nodes.append(
                Node(
                    package="tf2_ros",
                    executable="static_transform_publisher",
                    name=f"static_transform_publisher{number}",
                    arguments=["0"] * 6 + frames,
                )
            )
    return LaunchDescription(nodes)


def generate_spawn_controllers_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts the spawners of all controllers."""
    manager = moveit_config.trajectory_execution.get("moveit_simple_controller_manager", {})
    names = [*manager.get("controller_names", []), "joint_state_broadcaster"]
    nodes = [Node(package="controller_manager", executable="spawner", arguments=[name]) for name in names]
    return LaunchDescription(nodes)


def generate_warehouse_db_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts the database of MoveIt."""
    path = str(_folder(moveit_config) / "default_warehouse_mongo_db")
    node = Node(
        package="warehouse_ros_mongo",
        executable="mongo_wrapper_ros.py",
        parameters=[
            {
                "database_path": LaunchConfiguration("moveit_warehouse_database_path"),
                "warehouse_port": LaunchConfiguration("moveit_warehouse_port"),
                "warehouse_host": LaunchConfiguration("moveit_warehouse_host"),
            }
        ],
    )
    arguments = [
        DeclareLaunchArgument("moveit_warehouse_database_path", default_value=path),
        DeclareBooleanLaunchArg("reset"),
        DeclareLaunchArgument("moveit_warehouse_port", default_value="33829"),
        DeclareLaunchArgument("moveit_warehouse_host", default_value="localhost"),
    ]
    return LaunchDescription([*arguments, node])


def generate_move_group_launch(moveit_config: MoveItConfigs) -> LaunchDescription:
    """Return a description that starts the planner of motions."""
    truths = {"publish_monitored_planning_scene": True, "monitor_dynamics": False}
    capabilities = moveit_config.move_group_capabilities
    arguments = [
        DeclareBooleanLaunchArg("debug"),
        DeclareBooleanLaunchArg("allow_trajectory_execution", default_value=True),
        DeclareBooleanLaunchArg("publish_monitored_planning_scene", default_value=True),
        DeclareLaunchArgument("capabilities", default_value=capabilities.get("capabilities", "")),
        DeclareLaunchArgument("disable_capabilities", default_value=capabilities.get("disable_capabilities", "")),
        DeclareBooleanLaunchArg("monitor_dynamics", default_value=False),
    ]
    configuration = {
        "publish_robot_description_semantic": True,
        "allow_trajectory_execution": LaunchConfiguration("allow_trajectory_execution"),
        **{name: ParameterValue(LaunchConfiguration(name), value_type=str) for name in capabilities},
        **{name: LaunchConfiguration(name) for name in truths},
    }
    node = Node(
        package="moveit_ros_move_group",
        executable="move_group",
        parameters=[moveit_config.to_dict(), configuration],
    )
    return LaunchDescription([*arguments, node])


def generate_demo_launch(moveit_config: MoveItConfigs, launch_package_path: Any = None) -> LaunchDescription:
    """Return a description that starts all parts of MoveIt with controllers whose hardware is mocked."""
    folder = _folder(moveit_config) if launch_package_path is None else Path(launch_package_path)
    items: list[Any] = [
        DeclareBooleanLaunchArg("db"),
        DeclareBooleanLaunchArg("debug"),
        DeclareBooleanLaunchArg("use_rviz", default_value=True),
    ]
    for name, argument in (
        ("static_virtual_joint_tfs", ""),
        ("rsp", ""),
        ("move_group", ""),
        ("moveit_rviz", "use_rviz"),
        ("warehouse_db", "db"),
    ):
        file = folder / "launch" / f"{name}.launch.py"
        condition = IfCondition(LaunchConfiguration(argument)) if argument else None
        if name != "static_virtual_joint_tfs" or file.is_file():
            items.append(IncludeLaunchDescription(str(file), condition=condition))
    controllers = str(_folder(moveit_config) / "config" / "ros2_controllers.yaml")
    items.append(
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=[controllers],
            remappings=[("/controller_manager/robot_description", "/robot_description")],
        )
    )
    items.append(IncludeLaunchDescription(str(folder / "launch" / "spawn_controllers.launch.py")))
    return LaunchDescription(items)


def _folder(moveit_config: MoveItConfigs) -> Path:
    return moveit_config.package_path or Path()
