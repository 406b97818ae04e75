"""Heads that turn towards points and towards the point at a pixel."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit import Pose, msgs
from simkit.errors import InputError
from simkit.msgs.goal_status import GoalStatus
from simkit_control.plugins.ros2_control.head_pointing import HeadJoints, pixel_goal, pixel_ray

ACTION = "/head_controller/point_head_action"
YAML = """
controller_manager:
  ros__parameters:
    update_rate: 100
    head_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    point_head: {type: simkit/PointHeadAction}
head_controller:
  ros__parameters:
    joints: [pan, tilt]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
point_head:
  ros__parameters: {controller: head_controller, joints: [pan, tilt]}
"""
MASS = "<inertial><mass value='0.5'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>"


def _joint(name: str, kind: str, parent: str, child: str, origin: str, rest: str = "") -> str:
    ends = f"<parent link='{parent}'/><child link='{child}'/><origin {origin}/>"
    return f"<joint name='{name}' type='{kind}'>{ends}{rest}</joint>"


def _turning(axis: str, low: float, high: float) -> str:
    return f"<axis xyz='{axis}'/><limit lower='{low}' upper='{high}' effort='5' velocity='3'/>"


def _control(joint: str) -> str:
    kinds = "<command_interface name='position'/><state_interface name='position'/><state_interface name='velocity'/>"
    return f"<joint name='{joint}'>{kinds}</joint>"


OPTICAL = f"xyz='0.05 0.03 0.02' rpy='{-math.pi / 2} 0 {-math.pi / 2}'"
ROBOT = f"""
<robot name='rob'><link name='world'/>
<link name='base'>{MASS}</link>{_joint("fixed", "fixed", "world", "base", "xyz='0 0 0'")}
<link name='neck'>{MASS}</link><link name='skull'>{MASS}</link><link name='optical'/>
{_joint("pan", "revolute", "base", "neck", "xyz='0.2 0 1.0'", _turning("0 0 1", -1.3, 1.3))}
{_joint("tilt", "revolute", "neck", "skull", "xyz='0.02 0 0.1'", _turning("0 -1 0", -1.0, 0.8))}
{_joint("eye", "fixed", "skull", "optical", OPTICAL)}
<ros2_control name='sys' type='system'><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
{_control("pan")}{_control("tilt")}</ros2_control>
<gazebo><plugin filename='libgz_ros2_control-system.so' name='gz_ros2_control::GazeboSimROS2ControlPlugin'>
<parameters>head.yaml</parameters></plugin></gazebo></robot>
"""


@pytest.fixture
def sim(tmp_path: Path) -> Any:
    (tmp_path / "head.yaml").write_text(YAML)
    (tmp_path / "head.urdf").write_text(ROBOT)
    with simkit.load(tmp_path / "head.urdf") as sim:
        yield sim


def look(sim: Any, point: tuple[float, float, float], frame: str = "world", **more: Any) -> Any:
    goal = {
        "target": {"header": {"frame_id": frame}, "point": dict(zip("xyz", point, strict=True))},
        "pointing_axis": {"z": 1.0},
        "pointing_frame": "optical",
        **more,
    }
    handle = sim.send_goal(ACTION, goal)
    sim.run_until(lambda _: handle.is_done, 5.0)
    return handle


def axis_misses(sim: Any, point: tuple[float, float, float]) -> float:
    """Distance [m] at which the optical axis passes a point of the world."""
    pose = sim.link("rob::optical").pose
    return float(np.linalg.norm(np.cross(np.array(point) - pose.position, pose.rotate((0.0, 0.0, 1.0)))))


@pytest.mark.parametrize("point", [(2.0, 1.0, 0.4), (3.0, -2.0, 2.0), (0.6, 0.1, 1.2)])
def test_the_axis_of_the_camera_goes_through_the_point(sim: Any, point: tuple[float, float, float]) -> None:
    goal = look(sim, point)
    assert goal.status is GoalStatus.SUCCEEDED
    sim.run(0.5)
    assert axis_misses(sim, point) < 1e-3
    assert goal.feedback.pointing_angle_error < 0.02


def test_the_point_may_be_in_any_frame_of_the_robot(sim: Any) -> None:
    wanted = tuple(sim.link("rob::optical").pose.transform((0.3, 0.2, 1.5)))
    goal = look(sim, (0.3, 0.2, 1.5), "optical")
    sim.run(0.5)
    assert goal.status is GoalStatus.SUCCEEDED
    assert axis_misses(sim, wanted) < 1e-3
    assert look(sim, (1.0, 0.0, 0.0), "rob::base").status is GoalStatus.SUCCEEDED


def test_the_point_at_a_pixel_moves_to_the_image_centre(sim: Any) -> None:
    info = msgs.make(
        "sensor_msgs/msg/CameraInfo",
        header=msgs.header(0, "optical"),
        width=640,
        height=480,
        k=[520.0, 0.0, 320.0, 0.0, 520.0, 240.0, 0.0, 0.0, 1.0],
    )
    point = tuple(sim.link("rob::optical").pose.transform(np.array([(500 - 320) / 520, (100 - 240) / 520, 1.0]) * 2.0))
    goal = sim.send_goal(ACTION, pixel_goal(info, (500, 100), distance=2.0))
    sim.run(2.0)
    assert goal.status is GoalStatus.SUCCEEDED
    seen = sim.link("rob::optical").pose.inverse().transform(point)
    assert 520 * seen[0] / seen[2] == pytest.approx(0.0, abs=0.5)  # pixels
    assert 520 * seen[1] / seen[2] == pytest.approx(0.0, abs=0.5)


def test_the_head_takes_at_least_the_minimum_duration(sim: Any) -> None:
    slow = look(sim, (2.0, 2.2, 1.0), max_velocity=0.5)
    assert slow.status is GoalStatus.SUCCEEDED
    turned = abs(sim.joint("rob::pan").position)
    assert sim.time == pytest.approx(1.5 * turned / 0.5, abs=0.08)  # a cubic's peak
    start = sim.time
    look(sim, (2.0, 2.0, 1.0), min_duration={"sec": 1})
    assert sim.time - start == pytest.approx(1.0, abs=0.08)


def test_the_head_turns_towards_an_unreachable_point_up_to_its_limits(sim: Any) -> None:
    goal = look(sim, (-2.0, -1.0, 1.0))
    assert goal.status is GoalStatus.ABORTED
    assert goal.reason.startswith("the limits of the neck keep the pointing axis 1.")
    assert sim.joint("rob::pan").position == pytest.approx(-1.3, abs=0.005)


def test_a_cancelled_goal_leaves_the_head_where_it_is(sim: Any) -> None:
    goal = sim.send_goal(
        ACTION,
        {"target": {"point": {"x": 1.0, "y": 3.0, "z": 1.0}}, "pointing_frame": "optical", "pointing_axis": {"z": 1.0}},
    )
    sim.run(0.2)
    goal.cancel()
    sim.run(0.2)
    held = sim.joint("rob::pan").position
    sim.run(1.0)
    assert goal.status is GoalStatus.CANCELED
    assert sim.joint("rob::pan").position == pytest.approx(held, abs=1e-3)


@pytest.mark.parametrize(
    ("goal", "reason"),
    [
        ({"target": {"header": {"frame_id": "optcal"}}}, "there is no frame 'optcal'; did you mean 'optical'?"),
        ({"target": {"point": {"x": math.nan}}}, "the target has a coordinate that is NaN, infinite or too large"),
        ({"pointing_frame": "nose"}, "there is no frame 'nose'"),
        ({"pointing_frame": "neck"}, "the frame 'neck' is not turned by joint 'tilt'"),
        ({"pointing_frame": "map"}, "the frame 'map' is not turned by joint 'tilt'"),
        ({"pointing_frame": "base"}, "the frame 'base' is not turned by joint 'tilt'"),
        ({"max_velocity": -1.0}, "max_velocity and min_duration must be at least 0"),
        (
            {"target": {"header": {"frame_id": "optical"}}, "pointing_frame": "optical"},
            "the target is at the origin of the pointing frame",
        ),
    ],
)
def test_an_invalid_goal_is_rejected_with_the_reason(sim: Any, goal: dict[str, Any], reason: str) -> None:
    handle = sim.send_goal(ACTION, goal)
    sim.step(20)
    assert handle.status is GoalStatus.REJECTED
    assert handle.reason.startswith(reason)


def test_the_angles_for_two_crossing_axes_match_the_formula() -> None:
    neck = HeadJoints(
        np.zeros((2, 3)),
        np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]),
        np.zeros(2),
        np.array([-2.0, -1.0]),
        np.array([2.0, 1.0]),
        Pose(),
        np.array([1.0, 0.0, 0.0]),
    )
    x, y, z = target = np.array([1.0, -2.0, 0.7])
    angles, error = neck.aim(target)
    assert angles == pytest.approx([math.atan2(y, x), -math.atan2(z, math.hypot(x, y))], abs=1e-9)
    assert error < 1e-9


def test_a_distorted_pixel_gives_its_ray() -> None:
    x, y, k1, k2, p1, p2 = 0.3, -0.2, -0.1, 0.02, 0.001, -0.002
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2
    seen = (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)
    info = msgs.make(
        "sensor_msgs/msg/CameraInfo",
        distortion_model="plumb_bob",
        d=[k1, k2, p1, p2, 0.0],
        k=[500.0, 0.0, 320.0, 0.0, 480.0, 240.0, 0.0, 0.0, 1.0],
    )
    ray = pixel_ray(info, 500.0 * seen[0] + 320.0, 480.0 * seen[1] + 240.0)
    assert ray == pytest.approx([x, y, 1.0], abs=1e-8)
    with pytest.raises(InputError, match="both must be positive"):
        pixel_ray(msgs.make("sensor_msgs/msg/CameraInfo"), 0.0, 0.0)
