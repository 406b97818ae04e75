"""Motion planning under MoveIt's names: kinematics of a planar arm against formulas, plans around obstacles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from planar_arm import CONTROLLERS, SPEED, box, model, world

import simkit
from simkit import msgs
from simkit_motion.plugins.move_group.collision_shapes import voxels

pytest.importorskip("pinocchio")
pytest.importorskip("coal")

PLUGIN = '<plugin filename="libsimkit_move_group.so" name="move_group">{}</plugin>'
JOINTS = ("shoulder", "elbow", "wrist")
WALL = box("wall", "0.4396 0.2720 0.5 0 0 0.3", "0.3 0.04 0.5")  # 0.13 m to the left of the arm, parallel to it


def load(folder: Path, others: str = "", options: str = "", seed: int = 3) -> simkit.Simulation:
    """Load the planar arm: two links of 0.3 m and a hand, in the plane z = 0.5 m."""
    (folder / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    (folder / "lab.sdf").write_text(world(model(extra=PLUGIN.format(options), place="0 0 0 0 0 0.3") + others), "utf-8")
    sim = simkit.load(folder / "lab.sdf", seed=seed)
    sim.run(0.05)  # the controllers become active
    return sim


@pytest.fixture
def sim(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[simkit.Simulation]:
    with load(tmp_path, getattr(request, "param", "")) as found:
        yield found


def joint_goal(*values: float) -> dict[str, Any]:
    given = zip(JOINTS, values, strict=False)
    return {"joint_constraints": [{"joint_name": name, "position": value} for name, value in given]}


def place_goal(x: float, y: float) -> dict[str, Any]:
    region = {"primitive_poses": [{"position": {"x": x, "y": y, "z": 0.25}, "orientation": {"w": 1.0}}]}
    return {"position_constraints": [{"link_name": "hand", "constraint_region": region}]}


def run_goal(sim: simkit.Simulation, *goals: dict[str, Any], **request: Any) -> Any:
    asked = {"group_name": "arm", "goal_constraints": list(goals), **request}
    goal = sim.send_goal("/move_action", {"request": asked})
    sim.run_until(lambda _: goal.is_done, timeout=30.0)
    return goal


def hand(sim: simkit.Simulation) -> tuple[float, float]:
    pose = sim.model("arm").link("foot").pose.inverse() @ sim.model("arm").link("hand").pose
    return float(pose.position[0]), float(pose.position[1])


def seconds(point: Any) -> float:
    return float(point.time_from_start.sec + point.time_from_start.nanosec * 1e-9)


def test_forward_kinematics_is_that_of_two_links(sim: simkit.Simulation) -> None:
    state = {"joint_state": {"name": ["shoulder", "elbow"], "position": [0.4, -1.1]}}
    found = sim.call("/compute_fk", {"fk_link_names": ["hand"], "robot_state": state})
    pose = msgs.pose(found.pose_stamped[0])
    assert found.error_code.val == 1 and found.pose_stamped[0].header.frame_id == "foot"
    expected = (0.3 * (math.cos(0.4) + math.cos(-0.7)), 0.3 * (math.sin(0.4) + math.sin(-0.7)), 0.25)
    assert pose.position == pytest.approx(expected, abs=1e-12) and msgs.yaw(pose) == pytest.approx(-0.7)
    assert sim.model("arm").joint("shoulder").position == pytest.approx(0.0, abs=1e-6)  # the request moves nothing


@pytest.mark.parametrize("avoids", [False, True])
def test_inverse_kinematics_is_one_of_the_two_solutions(sim: simkit.Simulation, avoids: bool) -> None:
    x, y, yaw = 0.3 * (math.cos(0.2) + math.cos(1.5)), 0.3 * (math.sin(0.2) + math.sin(1.5)), 0.7
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    pose = {"pose": {"position": {"x": x, "y": y, "z": 0.25}, "orientation": turn}}
    asked = {"group_name": "arm", "pose_stamped": pose, "avoid_collisions": avoids}
    found = sim.call("/compute_ik", {"ik_request": asked})
    assert found.error_code.val == 1, found.error_code.message
    assert tuple(found.solution.joint_state.name) == JOINTS
    solutions = [(0.2, 1.3, -0.8), (1.5, -1.3, 0.5)]  # elbow right and elbow left
    assert min(np.abs(np.subtract(q, found.solution.joint_state.position)).max() for q in solutions) < 1e-5
    pose["pose"]["position"]["x"] = 0.7  # longer than the arm
    assert sim.call("/compute_ik", {"ik_request": asked}).error_code.val == -31


def test_a_joint_goal_is_reached_within_the_limits(sim: simkit.Simulation) -> None:
    goal = sim.send_goal(
        "/move_action", {"request": {"group_name": "arm", "goal_constraints": [joint_goal(1.2, -2.5)]}}
    )
    joints, speeds = [sim.model("arm").joint(name) for name in JOINTS], []
    while not goal.is_done:
        sim.run(0.01)
        speeds.append([float(joint.velocity) for joint in joints])
    assert goal.status.name == "SUCCEEDED" and goal.result.error_code.val == 1
    assert [float(joint.position) for joint in joints] == pytest.approx([1.2, -2.5, 0.0], abs=2e-3)
    points = goal.result.planned_trajectory.joint_trajectory.points
    # 2.5 rad with 2 rad/s² and at most 2 rad/s: 1 s to accelerate, 1 s to brake, and 0.25 s between
    assert seconds(points[-1]) == pytest.approx(2.25, rel=0.05)
    assert max(np.abs(point.velocities).max() for point in points) <= SPEED
    changes = np.diff([point.velocities for point in points], axis=0) / np.diff(list(map(seconds, points)))[:, None]
    assert np.abs(changes).max() <= 2.0
    assert np.abs(speeds).max() < 1.05 * SPEED


def test_the_scaling_factors_slow_a_plan_down_and_another_planner_is_told(sim: simkit.Simulation) -> None:
    """2.5 rad with a quarter of 2 rad/s² and half of 2 rad/s: 2 s to accelerate, 2 s to brake, 0.5 s between."""
    log = sim.subscribe("/rosout")
    request = {"planner_id": "SBLkConfigDefault", "allowed_planning_time": 2.0, "max_velocity_scaling_factor": 0.5}
    for factors in ({"max_acceleration_scaling_factor": 0.25}, {}):
        goal = run_goal(sim, joint_goal(0.0, -2.5), **request, **factors)
        if factors:
            points = goal.result.planned_trajectory.joint_trajectory.points
            assert seconds(points[-1]) == pytest.approx(4.5, rel=0.05)
            assert max(np.abs(point.velocities).max() for point in points) <= 0.5 * SPEED + 1e-9
    told = [message.msg for message in log.messages if "SBLkConfigDefault" in message.msg]
    assert told == ["the planner 'SBLkConfigDefault' does not exist here; RRT-Connect plans instead"]


@pytest.mark.parametrize("sim", [WALL], indirect=True)
def test_a_plan_goes_round_a_wall(sim: simkit.Simulation) -> None:
    goal = run_goal(sim, joint_goal(-1.2, 0.0, 0.0))
    assert goal.status.name == "SUCCEEDED"
    goal = sim.send_goal("/move_action", {"request": {"group_name": "arm", "goal_constraints": [place_goal(0.1, 0.5)]}})
    while not goal.is_done:
        sim.run(0.01)
        assert not sim.contacts("wall")
    assert goal.status.name == "SUCCEEDED", goal.reason
    assert hand(sim) == pytest.approx((0.1, 0.5), abs=2e-3)


@pytest.mark.parametrize("sim", [WALL], indirect=True)
def test_a_goal_in_the_wall_is_refused_with_the_names_of_the_shapes(sim: simkit.Simulation) -> None:
    goal = run_goal(sim, joint_goal(-1.5, 0.0, 0.0))
    assert goal.status.name == "SUCCEEDED"
    goal = run_goal(sim, joint_goal(0.25, 0.0, 0.0))
    assert (goal.status.name, goal.result.error_code.val) == ("ABORTED", -12)
    assert "wall::body" in goal.reason


@pytest.mark.parametrize(
    ("request_", "code", "text"),
    [
        ({"group_name": "amr", "goal_constraints": [joint_goal(0, 0)]}, -15, "did you mean 'arm'"),
        ({"group_name": "arm"}, -16, "no goal_constraints"),
        ({"group_name": "arm", "goal_constraints": [joint_goal(3.5, 0)]}, -27, "its limits are -2.8 and 2.8"),
        ({"group_name": "arm", "goal_constraints": [{"joint_constraints": [{"joint_name": "elbo"}]}]}, -16, "'elbow'"),
        ({"group_name": "arm", "goal_constraints": [place_goal(1.4, 0)]}, -31, "no joint positions"),
        (
            {
                "group_name": "arm",
                "goal_constraints": [joint_goal(1, 0)],
                "start_state": {"joint_state": {"name": ["elbow"], "position": [5.0]}},
            },
            -26,
            "starts at 5",
        ),
    ],
)
def test_an_invalid_request_has_an_error_code_and_a_reason(
    sim: simkit.Simulation, request_: dict[str, Any], code: int, text: str
) -> None:
    response = sim.call("/plan_kinematic_path", {"motion_plan_request": request_}).motion_plan_response
    assert response.error_code.val == code and text in response.error_code.message
    assert not len(response.trajectory.joint_trajectory.points)


def test_equal_requests_have_equal_plans(tmp_path: Path) -> None:
    asked = {"motion_plan_request": {"group_name": "arm", "goal_constraints": [place_goal(0.1, 0.5)]}}
    asked["motion_plan_request"]["start_state"] = {"joint_state": {"name": ["shoulder"], "position": [-1.2]}}
    plans = []
    for _ in range(2):
        with load(tmp_path, WALL) as sim:
            plans += [sim.call("/plan_kinematic_path", asked).motion_plan_response for _ in range(2)]
    assert plans[0].error_code.val == 1, plans[0].error_code.message
    assert len({msgs.serialize(plan) for plan in plans}) == 1


def test_objects_of_the_planning_scene_are_obstacles(sim: simkit.Simulation) -> None:
    def check(shoulder: float) -> int:
        asked = {"motion_plan_request": {"group_name": "arm", "goal_constraints": [joint_goal(shoulder, 0.0, 0.0)]}}
        return int(sim.call("/plan_kinematic_path", asked).motion_plan_response.error_code.val)

    def apply(**scene: Any) -> bool:
        return bool(sim.call("/apply_planning_scene", {"scene": {"is_diff": True, **scene}}).success)

    box: dict[str, Any] = {
        "id": "box",
        "primitives": [{"type": 1, "dimensions": [0.2, 0.2, 0.2]}],
        "header": {"frame_id": "foot"},
    }
    box["pose"] = {"position": {"y": 0.75, "z": 0.25}, "orientation": {"w": 1.0}}
    assert check(math.pi / 2) == 1
    assert apply(world={"collision_objects": [box]})
    assert check(math.pi / 2) == -12
    shown = sim.call("/get_planning_scene", {}).scene.world.collision_objects
    assert [(item.id, item.header.frame_id) for item in shown] == [("box", "world")]
    names = ["box", "hand"]
    matrix: dict[str, Any] = {
        "entry_names": names,
        "entry_values": [{"enabled": [False, True]}, {"enabled": [True, False]}],
    }
    assert apply(allowed_collision_matrix=matrix) and check(math.pi / 2) == 1
    matrix["entry_values"] = [{"enabled": [False, False]}] * 2
    assert apply(allowed_collision_matrix=matrix) and check(math.pi / 2) == -12
    attached = {"link_name": "hand", "object": {"id": "box"}, "touch_links": []}
    assert apply(robot_state={"attached_collision_objects": [attached]}) and check(math.pi / 2) == 1
    assert not apply(world={"collision_objects": [{"id": "bx", "operation": 1}]})
    assert not apply(world={"collision_objects": [{"id": "none"}]})
    assert not apply(world={"collision_objects": [{"id": "b", "primitives": [{"type": 1, "dimensions": [1.0]}]}]})


def test_a_straight_line_is_straight_and_ends_at_an_obstacle(sim: simkit.Simulation) -> None:
    state = {"joint_state": {"name": list(JOINTS), "position": [-0.9, 1.6, -0.7]}}
    begin = msgs.pose(sim.call("/compute_fk", {"fk_link_names": ["hand"], "robot_state": state}).pose_stamped[0])
    end = simkit.Pose(begin.position + np.array([0.1, 0.1, 0.0]), begin.quaternion)
    asked: dict[str, Any] = {"group_name": "arm", "start_state": state, "max_step": 0.01, "avoid_collisions": True}
    asked["waypoints"] = [msgs.pose_message(end)]
    line = sim.call("/compute_cartesian_path", asked)
    assert (line.error_code.val, line.fraction) == (1, 1.0), line.error_code.message
    a, b, c = np.array([point.positions for point in line.solution.joint_trajectory.points]).T
    x, y = 0.3 * (np.cos(a) + np.cos(a + b)), 0.3 * (np.sin(a) + np.sin(a + b))
    assert np.abs((x - x[0]) - (y - y[0])).max() < 1e-4 and np.abs(a + b + c).max() < 1e-4
    assert (x[-1], y[-1]) == pytest.approx(tuple(end.position[:2]), abs=1e-6)
    wall = {"id": "w", "primitives": [{"type": 1, "dimensions": [0.01, 2, 1]}], "header": {"frame_id": "foot"}}
    wall["pose"] = {"position": {"x": float(begin.position[0]) + 0.43 + 0.055}, "orientation": {"w": 1.0}}
    sim.call("/apply_planning_scene", {"scene": {"is_diff": True, "world": {"collision_objects": [wall]}}})
    line = sim.call("/compute_cartesian_path", asked)
    # the fingers end 0.43 m before the origin of the hand, 0.05 m from the wall; a plan keeps 0.01 m
    assert line.error_code.val == 1 and 0.3 <= line.fraction <= 0.4
    slow = sim.call("/compute_cartesian_path", {**asked, "avoid_collisions": False, "max_cartesian_speed": 0.02})
    assert seconds(slow.solution.joint_trajectory.points[-1]) > 0.1 * math.sqrt(2) / 0.02
    refused = sim.call("/compute_cartesian_path", {**asked, "max_step": 0.0})
    assert refused.error_code.val == 99999 and "max_step" in refused.error_code.message


def test_cubes_in_a_grid_are_checked_as_the_same_boxes_one_by_one() -> None:
    import coal

    random = np.random.default_rng(0)
    centres = np.unique(random.integers(0, 8, (60, 3)), axis=0) * 0.1 + (0.03, -0.4, 0.2)
    found = voxels(centres, 0.1)
    assert found is not None and voxels(centres + random.uniform(0, 0.03, centres.shape), 0.1) is None
    request, stick = coal.CollisionRequest(), coal.Capsule(0.02, 0.2)
    request.security_margin = 0.01

    def touches(shape: Any, place: Any, at: Any) -> bool:
        return bool(coal.collide(shape, coal.Transform3s(np.eye(3), place), stick, at, request, coal.CollisionResult()))

    box, answers = coal.Box(0.1, 0.1, 0.1), []
    for _ in range(100):
        at = coal.Transform3s(np.eye(3), random.uniform((0, -0.4, 0.2), (1.5, 1.1, 1.7)))
        answers.append(any(touches(box, centre, at) for centre in centres))
        assert touches(*found, at) == answers[-1]
    assert 5 < sum(answers) < 95


def test_a_snapshot_keeps_the_planning_scene(sim: simkit.Simulation) -> None:
    box = {"id": "box", "primitives": [{"type": 2, "dimensions": [0.1]}]}
    empty = sim.snapshot()
    sim.call("/apply_planning_scene", {"scene": {"is_diff": True, "world": {"collision_objects": [box]}}})
    full = sim.snapshot()

    def names() -> list[str]:
        return [item.id for item in sim.call("/get_planning_scene", {}).scene.world.collision_objects]

    sim.restore(empty)
    assert names() == []
    sim.restore(full)
    assert names() == ["box"]
    sim.reset()
    assert names() == []


def test_a_snapshot_during_a_motion_continues_it(sim: simkit.Simulation) -> None:
    goal = sim.send_goal(
        "/move_action", {"request": {"group_name": "arm", "goal_constraints": [joint_goal(0.8, -0.5)]}}
    )
    sim.run(0.6)
    middle, ends = sim.snapshot(), []
    for _ in range(2):
        sim.run_until(lambda _: goal.is_done, timeout=10.0)
        ends.append((goal.status.name, sim.time, sim.model("arm").joint("shoulder").position))
        sim.restore(middle)
        assert goal.is_active
    assert ends[0] == ends[1] and ends[0][0] == "SUCCEEDED"
    sim.reset()
    assert run_goal(sim, joint_goal(0.3)).status.name == "SUCCEEDED"


def test_a_trajectory_is_executed_and_cancelled(sim: simkit.Simulation) -> None:
    asked = {"motion_plan_request": {"group_name": "arm", "goal_constraints": [joint_goal(1.0, 1.0)]}}
    plan = sim.call("/plan_kinematic_path", asked).motion_plan_response.trajectory
    goal = sim.send_goal("/execute_trajectory", {"trajectory": plan})
    sim.run(0.5)
    goal.cancel()
    sim.run(0.5)
    assert (goal.status.name, goal.result.error_code.val) == ("CANCELED", -7)
    assert 0.0 < sim.model("arm").joint("shoulder").position < 0.9  # type: ignore[operator]
    late = sim.send_goal("/execute_trajectory", {"trajectory": plan})  # the robot is no longer at its start
    sim.run(0.1)
    assert (late.status.name, late.result.error_code.val) == ("ABORTED", -2)
    assert "away from the start" in late.reason


def test_an_unknown_joint_of_a_group_is_an_error(tmp_path: Path) -> None:
    options = "<group><name>g</name><joints>shoulder elbo</joints></group>"
    with pytest.raises(simkit.LoadError) as caught:
        load(tmp_path, options=options)
    assert "SK-PLAN-001" in str(caught.value) and "did you mean 'elbow'" in str(caught.value)
    options = "<group><name>g</name><joints>shoulder</joints><tip_link>hnd</tip_link></group>"
    with pytest.raises(simkit.LoadError, match="did you mean 'hand'"):
        load(tmp_path, options=options)


@pytest.mark.parametrize("collides", [False, True])
def test_links_of_a_robot_touch_only_with_self_collide(tmp_path: Path, collides: bool) -> None:
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS, "utf-8")
    (tmp_path / "lab.sdf").write_text(world(model()), "utf-8")
    with simkit.load(tmp_path / "lab.sdf", overrides=[f"arm.self_collide={str(collides).lower()}"]) as sim:
        for name, position in zip(JOINTS, (0.0, 2.6, 2.6), strict=True):  # the hand lies in the upper arm
            sim.model("arm").joint(name).set_position(position)
        sim.step()
        links = {tuple(sorted(name.split("::")[1] for name in (c.first, c.second))) for c in sim.contacts("arm")}
    assert (("hand", "upper") in links) is collides
    assert ("lower", "upper") not in links
