"""Topics that every world publishes: /clock and /tf_static."""

from __future__ import annotations

import numpy as np
from plugin_worlds import GROUND, classic_drive, rover, world, xyz

import simkit


def frames(message: object) -> dict[tuple[str, str], object]:
    return {(t.header.frame_id, t.child_frame_id): t.transform for t in message.transforms}  # type: ignore[attr-defined]


def test_the_clock_ticks_a_hundred_times_a_second() -> None:
    with simkit.load(world(GROUND)) as sim:
        clock = sim.subscribe("/clock")
        sim.run(0.1)
    assert [m.clock.nanosec for m in clock.messages] == [k * 10_000_000 for k in range(1, 11)]


def test_fixed_joints_of_a_moving_model_are_static_transforms() -> None:
    with simkit.load(world(GROUND, rover())) as sim:
        static = sim.subscribe("/tf_static")
        sim.step()
        found = frames(static.latest)
    assert set(found) == {("base", "front"), ("base", "rear")}
    np.testing.assert_allclose(xyz(found["base", "front"].translation), [0.18, 0, -0.09], atol=1e-12)  # type: ignore[attr-defined]


def test_a_late_subscriber_gets_static_transforms_too() -> None:
    with simkit.load(world(GROUND, rover())) as sim:
        sim.run(0.5)
        static = sim.subscribe("/tf_static")
        assert len(static.messages) == 1


def test_the_second_of_two_equal_models_has_its_own_frames() -> None:
    with simkit.load(world(GROUND, rover(), rover(name="second", pose="2 0 0 0 0 0"))) as sim:
        static = sim.subscribe("/tf_static")
        sim.step()
        assert ("second/base", "second/front") in frames(static.latest)


def test_static_transforms_include_a_spawned_model() -> None:
    with simkit.load(world(GROUND)) as sim:
        static = sim.subscribe("/tf_static")
        sim.run(0.5)
        assert static.messages == []
        sim.spawn(f"<sdf version='1.9'>{rover()}</sdf>")
        sim.run(1.0)
        assert ("base", "front") in frames(static.latest)


def test_the_frame_of_a_sensor_is_connected_to_its_link() -> None:
    sensor = "<sensor name='imu' type='imu'><pose>0.1 0 0.2 0 0 0</pose><update_rate>10</update_rate></sensor>"
    robot = rover().replace("<link name='base'>", f"<link name='base'>{sensor}")
    with simkit.load(world(GROUND, robot)) as sim:
        static = sim.subscribe("/tf_static")
        sim.step()
        found = frames(static.latest)
    np.testing.assert_allclose(xyz(found["base", "rover::base::imu"].translation), [0.1, 0, 0.2], atol=1e-12)  # type: ignore[attr-defined]


def test_base_frame_and_wheels_are_connected_on_tf() -> None:
    with simkit.load(world(GROUND, rover(classic_drive(publish_odom_tf="true", robot_base_frame="base")))) as sim:
        tf = sim.subscribe("/tf")
        sim.run(0.1)
        assert set(frames(tf.latest)) == {("odom", "base")}
