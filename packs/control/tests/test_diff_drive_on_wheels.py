"""The differential drive controller under a controller manager, on wheels that roll."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, element, rover, world, xyz, yaw

import simkit

CONTROL = "name='gz_ros2_control::GazeboSimROS2ControlPlugin' filename='libgz_ros2_control-system.so'"
CMD, ODOM = "/base/cmd_vel", "/base/odom"
WHEELS = {
    "left_wheel_names": "[left_wheel]",
    "right_wheel_names": "[right_wheel]",
    "wheel_separation": 0.4,
    "wheel_radius": 0.1,
    "cmd_vel_timeout": 0.25,
}


def opened(folder: Path, step: float = 0.001, seed: int = 0, **values: Any) -> simkit.Simulation:
    """The rover with the controller `base`, updated a hundred times a second."""
    lines = "".join(f"    {k}: {v}\n" for k, v in {**WHEELS, **values}.items() if v is not None)
    (folder / "base.yaml").write_text(
        "controller_manager:\n  ros__parameters:\n    update_rate: 100\n"
        "    base: {type: diff_drive_controller/DiffDriveController}\n"
        f"base:\n  ros__parameters:\n{lines}"
    )
    robot = rover(element("plugin", {"parameters": "base.yaml"}, CONTROL))
    path = folder / "world.sdf"
    path.write_text(world(GROUND, robot, step=step))
    return simkit.load(path, seed=seed)


def twist(ahead: float, turn: float = 0.0) -> Any:
    return simkit.msgs.make("geometry_msgs/msg/Twist", linear={"x": ahead}, angular={"z": turn})


def drive(sim: simkit.Simulation, ahead: float, turn: float, seconds: float) -> None:
    """Repeats a command ten times a second."""
    for _ in range(round(seconds * 10)):
        sim.publish(CMD, twist(ahead, turn))
        sim.run(0.1)


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_the_base_drives_straight_with_correct_odometry(tmp_path: Path, step: float) -> None:
    with opened(tmp_path, step, linear="{x: {max_acceleration: 1.0}}") as sim:
        odom = sim.subscribe(ODOM)
        sim.run(0.5)
        drive(sim, 0.5, 0.0, 2.0)
        sim.run(1.0)
        pose, told = sim.model("rover").pose, odom.latest
        assert told is not None
        # ten commands a second, the last at 1.9 s, hold until 2.15 s: 1.075 m but for the moment that each waits
        assert pose.position[0] == pytest.approx(1.075, abs=0.02)
        assert abs(pose.position[1]) < 1e-3 and abs(pose.rpy[2]) < 1e-3
        assert told.pose.pose.position.x == pytest.approx(pose.position[0], rel=5e-3)
        assert told.twist.twist.linear.x == pytest.approx(0, abs=1e-3)


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_the_base_turns_about_its_centre_with_correct_odometry(tmp_path: Path, step: float) -> None:
    with opened(tmp_path, step) as sim:
        odom = sim.subscribe(ODOM)
        sim.run(0.5)
        drive(sim, 0.0, 1.0, 3.0)
        sim.run(1.0)
        pose, told = sim.model("rover").pose, odom.latest
        assert told is not None
        assert math.remainder(yaw(told.pose.pose.orientation) - pose.rpy[2], 2 * math.pi) == pytest.approx(0, abs=0.02)
        assert abs(pose.rpy[2]) > 3 and np.linalg.norm(pose.position[:2]) < 5e-3


def test_the_base_stops_without_commands(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        drive(sim, 0.5, 0.0, 0.5)
        sim.run(1.0)
        before = sim.model("rover").pose
        sim.run(5.0)
        after = sim.model("rover").pose
    np.testing.assert_allclose(after.position, before.position, atol=1e-5)


def test_odometry_is_stamped_on_the_grid_of_its_rate(tmp_path: Path) -> None:
    with opened(tmp_path, publish_rate=25.0) as sim:
        odom = sim.subscribe(ODOM)
        sim.run(1.0)
        times = np.array([m.header.stamp.nanosec + m.header.stamp.sec * 10**9 for m in odom.messages])
    assert np.all(np.diff(times) == 40_000_000) and len(times) in (24, 25)


def test_in_ros_1_missing_wheel_sizes_come_from_the_model(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text(
        "rover:\n  base:\n    type: diff_drive_controller/DiffDriveController\n"
        "    left_wheel: left_wheel\n    right_wheel: [right_wheel]\n"
    )
    plugin = element("plugin", {"parameters": "base.yaml"}, "name='control' filename='libgazebo_ros_control.so'")
    (tmp_path / "world.sdf").write_text(world(GROUND, rover(plugin)))
    with simkit.load(tmp_path / "world.sdf") as sim:
        odom = sim.subscribe("/rover/base/odom")

        def drive_on() -> tuple[Any, Any]:
            for _ in range(5):
                sim.publish("/rover/base/cmd_vel", twist(0.3, 0.5))
                sim.run(0.1)
            return odom.latest.pose.pose, sim.model("rover").pose

        told_before, before = drive_on()  # no limit of acceleration: the wheels spin at first
        told, pose = drive_on()
        turned = yaw(told.orientation) - yaw(told_before.orientation)
        assert turned == pytest.approx(pose.rpy[2] - before.rpy[2], rel=2e-3)
        np.testing.assert_allclose(xyz(told.position)[:2], pose.position[:2], atol=0.01)
        assert [d.code for d in sim.engine.reports].count("SK-CONTROL-044") == 2


def test_reset_and_restore_give_the_same_motion(tmp_path: Path) -> None:
    with opened(tmp_path, linear="{x: {max_acceleration: 1.0}}") as sim:
        odom = sim.subscribe(ODOM)

        def go(seconds: float) -> list[float]:
            drive(sim, 0.4, 0.7, seconds)
            assert odom.latest is not None
            return [*xyz(odom.latest.pose.pose.position), *sim.model("rover").pose.position]

        first = go(1.0)
        snapshot = sim.snapshot()
        second = go(1.0)
        sim.restore(snapshot)
        assert go(1.0) == second
        sim.reset()
        assert go(1.0) == first


def test_a_missing_wheel_is_reported_with_the_closest_name(tmp_path: Path) -> None:
    with pytest.raises(simkit.LoadError, match="left_weel") as caught:
        opened(tmp_path, left_wheel_names="[left_weel]")
    assert "left_wheel" in str(caught.value) and "base.yaml" in str(caught.value)
