"""Navigator and waypoint follower with servers of a script: trees of goals, log, preemption, waypoints, restore."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from navigation_worlds import pose

import simkit
from simkit.errors import LoadError

TREE = """<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence>
  <Spin spin_dist="0.5"/><Fallback><BackUp error_code_id="{code}"/><Wait wait_duration="0.1"/></Fallback>
</Sequence></BehaviorTree></root>"""


def world(options: str = "", followers: str = "") -> str:
    """Return a world with a navigator whose robot is always at the origin of the map."""
    navigator = f'<plugin filename="libsimkit_bt_navigator.so" name="bt_navigator">{options}'
    frame = "<robot_base_frame>map</robot_base_frame></plugin>"
    return f'<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{navigator}{frame}{followers}</world></sdf>'


SERVER = '<plugin filename="libsimkit_behavior_server.so" name="behavior_server">{}</plugin>'
BEHAVIORS = SERVER.format("<robot_base_frame>odom</robot_base_frame>")


def test_a_goal_names_its_tree_and_each_change_of_a_node_is_logged(tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(TREE)
    with simkit.load(world()) as sim:
        asked: list[str] = []
        events: list[tuple[str, str, str]] = []
        sim.subscribe(
            "/behavior_tree_log",
            lambda message: events.extend(
                (e.node_name, e.previous_status, e.current_status) for e in message.event_log
            ),
        )

        def serve(name: str, kind: str, end: str) -> None:
            def execute(goal: Any) -> None:
                asked.append(name)
                getattr(goal, end)({"error_code": 714} if end == "abort" else None)

            sim.act(name, f"nav2_msgs/action/{kind}", execute)

        serve("/spin", "Spin", "succeed")
        serve("/backup", "BackUp", "abort")
        serve("/wait", "Wait", "succeed")
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.0), "behavior_tree": str(tmp_path / "tree.xml")})
        sim.run(0.3)
        assert goal.status.name == "SUCCEEDED" and asked == ["/spin", "/backup", "/wait"]
        assert goal.feedback.number_of_recoveries == 3
        changes = [event for event in events if event[0] == "BackUp"]
        assert changes == [
            ("BackUp", "IDLE", "RUNNING"),
            ("BackUp", "RUNNING", "FAILURE"),
            ("BackUp", "FAILURE", "IDLE"),
        ]


def test_a_goal_with_a_tree_that_has_problems_is_rejected_with_the_first_one(tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(TREE.replace("Spin ", "Spinn "))
    with simkit.load(world()) as sim:
        for name, reason in (
            (str(tmp_path / "tree.xml"), "there is no node <Spinn>"),
            ("nowhere.xml", "there is no behaviour tree 'nowhere.xml'"),
        ):
            goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.0), "behavior_tree": name})
            sim.run(0.1)
            assert (goal.status.name, goal.reason) == ("REJECTED", reason)


def test_a_default_tree_that_does_not_exist_is_an_error_of_the_world() -> None:
    with pytest.raises(LoadError) as caught:
        simkit.load(world("<default_nav_to_pose_bt_xml>navigate_w_replaning_time.xml</default_nav_to_pose_bt_xml>"))
    assert "SK-BT-008" in str(caught.value) and "did you mean 'navigate_w_replanning_time.xml'?" in str(caught.value)


def test_a_world_file_names_trees_in_its_folder_only(tmp_path: Path) -> None:
    inner = tmp_path / "worlds"
    inner.mkdir()
    (tmp_path / "tree.xml").write_text(TREE)
    (inner / "own.xml").write_text(TREE)
    file = inner / "world.sdf"
    option = "<default_nav_to_pose_bt_xml>{}</default_nav_to_pose_bt_xml>"
    for outside in (str(tmp_path / "tree.xml"), "../tree.xml"):
        file.write_text(world(option.format(outside)))
        with pytest.raises(LoadError, match="SK-BT-008"):
            simkit.load(file)
    file.write_text(world(option.format("own.xml")))
    with simkit.load(file) as sim:
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.0), "behavior_tree": str(tmp_path / "tree.xml")})
        sim.run(0.1)
        assert (goal.status.name, "there is no behaviour tree" in goal.reason) == ("REJECTED", True)


def test_a_goal_with_another_tree_waits_for_the_end_of_the_active_one(tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(TREE)
    with simkit.load(world()) as sim:
        sim.act("/compute_path_to_pose", "nav2_msgs/action/ComputePathToPose", lambda goal: None)
        first = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.0)})
        sim.run(0.1)
        other = sim.send_goal(
            "/navigate_to_pose", {"pose": pose(1.0, 0.0), "behavior_tree": str(tmp_path / "tree.xml")}
        )
        sim.run(0.1)
        assert first.status.name == "EXECUTING" and other.status.name == "REJECTED"
        assert "another behaviour tree" in other.reason and "cancel it first" in other.reason


def test_a_restore_in_a_tree_repeats_it(tmp_path: Path) -> None:
    tree = "<Sequence><Wait wait_duration='0.5'/><Delay delay_msec='300'><Wait wait_duration='0.2'/></Delay></Sequence>"
    text = f'<root><BehaviorTree ID="Main"><Repeat num_cycles="3">{tree}</Repeat></BehaviorTree></root>'
    (tmp_path / "tree.xml").write_text(text)
    with simkit.load(world(followers=BEHAVIORS)) as sim:
        goal = sim.send_goal("/navigate_to_pose", {"pose": pose(1.0, 0.0), "behavior_tree": str(tmp_path / "tree.xml")})
        sim.run(1.7)
        kept, ends = sim.snapshot(), []
        for _ in range(2):
            while not goal.is_done and sim.time < 9.0:
                sim.step()
            assert goal.status.name == "SUCCEEDED"
            ends.append(sim.time)
            sim.restore(kept)
            assert goal.status.name == "EXECUTING"
        assert ends[0] == ends[1] == pytest.approx(3.2, abs=0.7)


def test_a_person_drives_more_slowly_towards_an_obstacle_and_ends_the_drive() -> None:
    cells = [0] * 1600
    for row in range(40):
        cells[row * 40 + 32] = 254  # x from 0.6 to 0.65 m
    metadata = {"size_x": 40, "size_y": 40, "resolution": 0.05, "origin": {"position": {"x": -1.0, "y": -1.0}}}
    costmap = {"header": {"frame_id": "odom"}, "metadata": metadata, "data": cells}
    with simkit.load(world(followers=BEHAVIORS)) as sim:
        sim.advertise("/local_costmap/costmap_raw", "nav2_msgs/msg/Costmap", latched=True).publish(costmap)
        sent = sim.subscribe("/cmd_vel", keep=1)
        goal = sim.send_goal("/assisted_teleop", {"time_allowance": {"sec": 9}})
        speeds = []
        for command in (0.2, 1.0, -0.5):
            sim.publish("/cmd_vel_teleop", {"linear": {"x": command}})
            sim.run(0.3)
            speeds.append(sent.latest.linear.x)
        assert speeds == pytest.approx([0.2, 0.5, -0.5])  # 1 m/s would reach the obstacle within 0.6 s
        sim.publish("/preempt_teleop", {})
        sim.run(0.2)
        assert goal.status.name == "SUCCEEDED" and sent.latest.linear.x == 0.0


def test_a_drive_that_contradicts_itself_is_not_valid() -> None:
    with simkit.load(world(followers=BEHAVIORS)) as sim:
        for name, target, speed, code in (
            ("drive_on_heading", {"x": 0.3}, -0.1, 724),
            ("drive_on_heading", {"x": 0.3, "y": 0.1}, 0.1, 724),
            ("backup", {"x": 0.3}, 0.0, 713),
        ):
            goal = sim.send_goal(f"/{name}", {"target": target, "speed": speed})
            sim.step(2)
            assert (goal.status.name, goal.result.error_code) == ("ABORTED", code)


# ---------------------------------------------------------------------- waypoints

FOLLOWER = '<plugin filename="libsimkit_waypoint_follower.so" name="waypoint_follower">{}</plugin>'


def walk(options: str, request: dict[str, Any], seconds: float = 2.0) -> tuple[Any, list[float]]:
    """Return the goal of a walk, and the x of the waypoints to which the robot was sent; x < 0 is not reached."""
    text = f'<sdf version="1.9"><world name="w">{FOLLOWER.format(options)}</world></sdf>'
    with simkit.load(text) as sim:
        places: list[float] = []

        def drive(goal: Any) -> None:
            places.append(goal.request.pose.pose.position.x)
            if places[-1] < 0:
                goal.abort({"error_code": 208})
            else:
                goal.succeed()

        sim.act("/navigate_to_pose", "nav2_msgs/action/NavigateToPose", drive)
        goal = sim.send_goal(
            "/follow_waypoints", {"poses": [pose(1.0, 0.0), pose(-2.0, 0.0), pose(3.0, 0.0)], **request}
        )
        sim.run(seconds)
        return goal, places


def test_missed_waypoints_are_in_the_result_and_a_walk_has_loops() -> None:
    goal, places = walk("<stop_on_failure>false</stop_on_failure>", {"number_of_loops": 1, "goal_index": 1})
    assert goal.status.name == "SUCCEEDED" and places == [-2.0, 3.0, 1.0, -2.0, 3.0]
    assert [(missed.index, missed.error_code) for missed in goal.result.missed_waypoints] == [(1, 208), (1, 208)]


def test_the_first_missed_waypoint_ends_the_walk() -> None:
    goal, places = walk("", {})
    assert (goal.status.name, goal.result.error_code, places) == ("ABORTED", 208, [1.0, -2.0])
    assert goal.result.missed_waypoints[0].goal.pose.position.x == -2.0


def test_a_waypoint_without_the_input_of_its_task_is_missed() -> None:
    name = "<waypoint_task_executor_plugin>ask</waypoint_task_executor_plugin>"
    task = "<ask><plugin>nav2_waypoint_follower::InputAtWaypoint</plugin><timeout>0.5</timeout></ask>"
    goal, places = walk(name + task, {})
    assert (goal.status.name, goal.result.error_code, places) == ("ABORTED", 601, [1.0])


def test_waypoints_of_gps_need_the_service_that_converts_them() -> None:
    with simkit.load(f'<sdf version="1.9"><world name="w">{FOLLOWER.format("")}</world></sdf>') as sim:
        goal = sim.send_goal("/follow_gps_waypoints", {"gps_poses": [{"position": {"latitude": 48.0}}]})
        sim.run(0.1)
        assert goal.status.name == "REJECTED" and "navsat_transform_node" in goal.reason
