"""Commands for Nav2 in programs: `nav2_simple_commander`, with the navigation of simkit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest

import simkit
from simkit_navigation.plugins.maps.map_server import MapServer
from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.nav2_simple_commander.costmap_2d import PyCostmap2D
from simkit_nodes.ros_modules.nav2_simple_commander.footprint_collision_checker import (
    LETHAL_OBSTACLE,
    FootprintCollisionChecker,
)
from simkit_nodes.ros_modules.nav2_simple_commander.line_iterator import LineIterator

NAVIGATION = """<sdf version="1.9"><model name="navigation"><static>true</static><link name="link"/>
  <plugin filename="libsimkit_fake_localization.so" name="fake_localization"/>
  <plugin filename="libsimkit_costmap_2d.so" name="global_costmap"><robot_radius>0.24</robot_radius></plugin>
  <plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
    <global_frame>odom</global_frame><rolling_window>true</rolling_window><width>3</width><height>3</height>
    <robot_radius>0.24</robot_radius><plugins>obstacle_layer inflation_layer</plugins>
  </plugin>
  <plugin filename="libsimkit_planner_server.so" name="planner_server"/>
  <plugin filename="libsimkit_controller_server.so" name="controller_server"><robot_radius>0.24</robot_radius></plugin>
  <plugin filename="libsimkit_behavior_server.so" name="behavior_server"/>
  <plugin filename="libsimkit_bt_navigator.so" name="bt_navigator"/>
</model></sdf>"""

PROGRAM = """
import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult

rclpy.init()
navigator = BasicNavigator()
navigator.waitUntilNav2Active(localizer="bt_navigator")
goal = PoseStamped()
goal.header.frame_id = "map"
goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w = -1.6, -0.4, 1.0
path = navigator.getPath(goal, goal)
navigator.info(f"path {len(path.poses) > 3}")
navigator.goToPose(goal)
while not navigator.isTaskComplete():
    feedback = navigator.getFeedback()
navigator.info(f"{navigator.getResult().name} {feedback.distance_remaining < 0.5}")
navigator.spin(3.0)
navigator.cancelTask()
while not navigator.isTaskComplete():
    pass
navigator.info(f"{navigator.getResult() is TaskResult.CANCELED}")
navigator.clearAllCostmaps()
navigator.info(f"{navigator.getLocalCostmap().metadata.size_x}")
navigator.lifecycleShutdown()
"""


def test_a_navigator_drives_the_robot_to_a_pose(tmp_path: Path) -> None:
    file, model = tmp_path / "program.py", tmp_path / "navigation.sdf"
    file.write_text(PROGRAM)
    model.write_text(NAVIGATION)
    with simkit.load("turtlebot3_world", plugins=[MapServer()], spawn=[str(model)]) as sim:
        node = sim.add_node(file)
        while sim.time < 30.0 and not node.done:
            sim.run(1.0)
        position = sim.model("turtlebot3").pose.position
    assert node.error is None, "\n".join(node.log)
    texts = [line.split("]: ", 1)[1] for line in node.log if "]: " in line]
    assert texts[:3] == ["Nav2 is ready for use!", "Getting path...", "path True"]
    assert "SUCCEEDED True" in texts
    assert texts[-4:-1] == ["Canceling current task.", "True", "30"]
    assert position[:2] == pytest.approx((-1.6, -0.4), abs=0.3)


def test_a_navigator_without_nav2_waits_and_says_so(run_program: Callable[..., list[str]]) -> None:
    lines = run_program(
        """
        import rclpy
        from nav2_simple_commander.robot_navigator import BasicNavigator
        rclpy.init()
        BasicNavigator().waitUntilNav2Active()
        """,
        2.5,
    )
    assert lines == ["amcl/get_state service not available, waiting..."] * 2


def costmap() -> PyCostmap2D:
    grid = ROS2.message_class("nav_msgs/msg/OccupancyGrid")()
    grid.info.width, grid.info.height, grid.info.resolution = 4, 3, 0.5
    grid.info.origin.position.x = -1.0
    grid.data = [0, 10, 20, 30, 0, 0, 0, 0, 0, 100, 0, -1]
    return PyCostmap2D(grid)


def test_a_costmap_has_cells_at_positions() -> None:
    costs = costmap()
    assert costs.worldToMapValidated(-0.9, 1.2) == (0, 2)
    assert costs.worldToMapValidated(1.1, 0.0) == (None, None)
    assert costs.mapToWorld(1, 2) == (-0.25, 1.25)
    assert int(costs.getCostXY(3, 0)) == 30
    assert int(costs.getCostIdx(11)) == 255
    costs.setCost(0, 0, np.uint8(254))
    assert int(costs.getCostXY(0, 0)) == 254


@pytest.mark.parametrize(
    ("line", "points"),
    [
        ((0, 0, 2, 1, 1), [(0, 0), (1, 0.5), (2, 1)]),
        ((2, 0, 0, 0, 1.5), [(2, 0), (0.5, 0), (0, 0)]),
        ((1, 3, 1, 1), [(1, 3), (1, 2), (1, 1)]),
    ],
)
def test_a_line_has_points_up_to_its_end(line: tuple[float, ...], points: list[tuple[float, float]]) -> None:
    iterator, visited = LineIterator(*line), []
    while iterator.isValid():
        visited.append((iterator.getX(), iterator.getY()))
        iterator.advance()
    assert visited == points


def test_a_footprint_has_the_largest_cost_of_its_edges() -> None:
    polygon, point = (ROS2.message_class(f"geometry_msgs/msg/{name}") for name in ("Polygon", "Point32"))
    square = polygon(points=[point(x=x, y=y) for x, y in ((0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9))])
    checker = FootprintCollisionChecker()
    with pytest.raises(ValueError, match="Costmap not specified"):
        checker.footprintCost(square)
    checker.setCostmap(costmap())
    assert checker.footprintCost(square) == 30
    assert checker.footprintCostAtPose(5.0, 0.0, 0.0, square) == LETHAL_OBSTACLE


def test_the_navigator_of_the_turtlebot_4_docks(sim: simkit.Simulation, tmp_path: Path) -> None:
    base = tmp_path / "base.py"
    base.write_text(
        dedent(
            """
            import rclpy
            from irobot_create_msgs.action import Dock, Undock
            from irobot_create_msgs.msg import DockStatus
            from rclpy.action import ActionServer
            rclpy.init()
            node = rclpy.create_node("base")
            status = DockStatus(is_docked=True)
            publisher = node.create_publisher(DockStatus, "dock_status", 10)
            node.create_timer(0.1, lambda: publisher.publish(status))
            def undock(handle):
                status.is_docked = False
                handle.succeed()
                return Undock.Result()
            def dock(handle):
                handle.abort()
                return Dock.Result()
            servers = ActionServer(node, Undock, "undock", undock), ActionServer(node, Dock, "dock", dock)
            rclpy.spin(node)
            """
        )
    )
    program = tmp_path / "mail.py"
    program.write_text(
        dedent(
            """
            import rclpy
            from turtlebot4_navigation.turtlebot4_navigator import TurtleBot4Directions, TurtleBot4Navigator
            rclpy.init()
            navigator = TurtleBot4Navigator()
            navigator.info(f"{navigator.getDockedStatus()}")
            navigator.undock()
            navigator.dock()
            pose = navigator.getPoseStamped([1.0, 2.0], TurtleBot4Directions.SOUTH)
            navigator.info(f"{pose.header.frame_id} {pose.pose.position.y} {pose.pose.orientation.z:.3f}")
            """
        )
    )
    sim.add_node(base)
    node = sim.add_node(program)
    sim.run(2.0)
    assert node.error is None, "\n".join(node.log)
    assert [line.split("]: ", 1)[1] for line in node.log] == [
        "True",
        "Undocking...",
        "Undock succeeded",
        "Docking...",
        "Goal failed with status code: 6",
        "map 2.0 1.000",
    ]
