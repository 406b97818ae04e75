"""Motion planning under MoveIt's names: mistakes of a user are answered with an error code, and never end the run."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_move_group import joint_goal, load, place_goal

import simkit
from simkit import msgs

pytest.importorskip("pinocchio")
pytest.importorskip("coal")

BOX = {"type": 1, "dimensions": [0.1, 0.1, 0.1]}


@pytest.fixture
def sim(tmp_path: Path) -> Iterator[simkit.Simulation]:
    with load(tmp_path) as found:
        yield found


def apply(sim: simkit.Simulation, **scene: Any) -> bool:
    return bool(sim.call("/apply_planning_scene", {"scene": {"is_diff": True, **scene}}).success)


def plan(sim: simkit.Simulation, **fields: Any) -> Any:
    asked = {"group_name": "arm", "goal_constraints": [joint_goal(0.5)], **fields}
    return sim.call("/plan_kinematic_path", {"motion_plan_request": asked}).motion_plan_response.error_code


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("allowed_planning_time", float("nan")),
        ("allowed_planning_time", float("inf")),
        ("allowed_planning_time", -1.0),
        ("max_velocity_scaling_factor", 1e-9),  # five thousand million points
    ],
)
def test_a_number_that_gives_no_plan_is_refused(sim: simkit.Simulation, field: str, value: float) -> None:
    answer = plan(sim, **{field: value})
    assert answer.val == -2 and field in answer.message


def test_a_line_may_begin_with_the_present_pose(sim: simkit.Simulation) -> None:
    state = {"joint_state": {"name": ["shoulder", "elbow", "wrist"], "position": [-0.9, 1.6, -0.7]}}
    here = msgs.pose(sim.call("/compute_fk", {"fk_link_names": ["hand"], "robot_state": state}).pose_stamped[0])
    away = simkit.Pose(here.position + np.array([0.1, 0.0, 0.0]), here.quaternion)
    asked = {"group_name": "arm", "start_state": state, "max_step": 0.01}
    asked["waypoints"] = [msgs.pose_message(pose) for pose in (here, away, away)]
    line = sim.call("/compute_cartesian_path", asked)
    rows = [[*point.positions, *point.velocities] for point in line.solution.joint_trajectory.points]
    assert line.fraction == 1.0 and len(rows) > 5 and np.isfinite(rows).all()
    far = msgs.make("geometry_msgs/msg/Pose", position={"x": 1e300}, orientation={"w": 1.0})
    with np.errstate(over="ignore"):
        assert "max_step" in sim.call("/compute_cartesian_path", {**asked, "waypoints": [far]}).error_code.message
    slow = sim.call("/compute_cartesian_path", {**asked, "max_cartesian_speed": 1e-12})
    assert slow.error_code.val == -2 and "max_cartesian_speed" in slow.error_code.message


def test_one_goal_of_several_is_enough(sim: simkit.Simulation) -> None:
    far, out = place_goal(5.0, 5.0), joint_goal(9.0)
    assert plan(sim, goal_constraints=[far, out]).val == -31
    assert plan(sim, goal_constraints=[far, out, joint_goal(0.3)]).val == 1


def test_fields_without_effect_are_refused(sim: simkit.Simulation) -> None:
    stamped = {"pose": {"position": {"x": 0.5, "z": 0.25}, "orientation": {"w": 1.0}}}
    for several in ({"pose_stamped_vector": [stamped, stamped]}, {"ik_link_names": ["hand", "hand"]}):
        asked = {"group_name": "arm", "pose_stamped": stamped, **several}
        answer = sim.call("/compute_ik", {"ik_request": asked}).error_code
        assert answer.val == -31 and "several links" in answer.message
    limited = {"group_name": "arm", "pose_stamped": stamped, "constraints": joint_goal(0.3)}
    answer = sim.call("/compute_ik", {"ik_request": limited}).error_code
    assert answer.val == 99999 and "ik_request constraints are not supported" in answer.message
    scene = {"world": {"collision_objects": [{"id": "b", "primitives": [BOX]}]}}
    request = {"group_name": "arm", "goal_constraints": [joint_goal(0.3)]}
    goal = sim.send_goal("/move_action", {"request": request, "planning_options": {"planning_scene_diff": scene}})
    sim.step()
    assert goal.status.name == "ABORTED" and "apply_planning_scene" in goal.reason


def test_an_invalid_object_leaves_the_scene_as_it_was(sim: simkit.Simulation) -> None:
    nan = {"position": {"x": float("nan")}, "orientation": {"w": 0.0}}
    assert not apply(sim, world={"collision_objects": [{"id": "b", "primitives": [BOX], "pose": nan}]})
    nameless = {"link_name": "hand", "object": {"primitives": [BOX]}}
    assert not apply(sim, robot_state={"attached_collision_objects": [nameless]})
    plane = {"link_name": "hand", "object": {"id": "p", "planes": [{"coef": [0.0, 0.0, 1.0, 5.0]}]}}
    assert apply(sim, robot_state={"attached_collision_objects": [plane]})


def test_a_message_that_is_used_again_does_not_change_the_scene(sim: simkit.Simulation) -> None:
    kind = "moveit_msgs/srv/ApplyPlanningScene_Request"
    far = {"position": {"x": 5.0}, "orientation": {"w": 1.0}}
    item = {"id": "first", "primitives": [BOX], "pose": far}
    request = msgs.make(kind, scene={"is_diff": True, "world": {"collision_objects": [item]}})
    sim.call("/apply_planning_scene", request)
    request.scene.world.collision_objects[0].id = "second"
    request.scene.world.collision_objects[0].primitives[0].dimensions[0] = -1.0
    assert [o.id for o in sim.call("/get_planning_scene", {}).scene.world.collision_objects] == ["first"]
    assert plan(sim).val == 1


def test_without_coal_the_scene_stays_as_it_was(sim: simkit.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *more: None if name == "coal" else find(name, *more))
    monkeypatch.setitem(sys.modules, "coal", None)
    assert not apply(sim, world={"collision_objects": [{"id": "b", "primitives": [BOX]}]})
    assert "the package coal is not installed" in plan(sim).message


def test_the_robot_may_be_removed_during_a_motion(sim: simkit.Simulation) -> None:
    goal = sim.send_goal("/move_action", {"request": {"group_name": "arm", "goal_constraints": [joint_goal(1.0)]}})
    sim.run(0.3)
    sim.remove("arm")
    sim.run(0.1)
    assert (goal.status.name, goal.reason) == ("ABORTED", "the action was removed")


@pytest.mark.parametrize("state", ["PLANNING", "MONITOR"])
def test_the_robot_may_be_removed_by_the_callback_of_the_feedback(sim: simkit.Simulation, state: str) -> None:
    def remove(feedback: Any) -> None:
        if feedback.state == state:
            sim.remove("arm")

    request = {"group_name": "arm", "goal_constraints": [joint_goal(1.0)]}
    goal = sim.send_goal("/move_action", {"request": request}, remove)
    sim.run(0.2)
    assert (goal.status.name, goal.reason) == ("ABORTED", "the action was removed")


@pytest.mark.parametrize(("joints", "text"), [("standing shoulder", "exactly one"), ("elbow elbow", "listed twice")])
def test_joints_of_a_group_have_one_axis_and_are_listed_once(tmp_path: Path, joints: str, text: str) -> None:
    with pytest.raises(simkit.LoadError, match=text):
        load(tmp_path, options=f"<group><name>g</name><joints>{joints}</joints></group>")
