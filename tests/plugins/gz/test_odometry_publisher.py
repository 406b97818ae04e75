"""Odometry from the true motion."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit


def load(parameters: str = "", seed: int = 0) -> simkit.Simulation:
    text = f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m"><pose>1 2 3 0 0 0.5</pose>
    <link name="base"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
    <plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">{parameters}</plugin>
    </model></world></sdf>"""
    return simkit.load(text, seed=seed)


def test_in_the_plane_pose_and_twist_are_those_of_the_world_and_of_the_body() -> None:
    sim = load()
    odometry, tf = sim.subscribe("/model/m/odometry"), sim.subscribe("/model/m/pose")
    sim.model("m").set_velocity((0.3, 0.4, 0.2), (0, 0, 0.6))
    sim.run(1.0)
    message = odometry.latest
    assert len(odometry.messages) == 50
    assert (message.header.frame_id, message.child_frame_id) == ("m/odom", "m/base_footprint")
    point, linear = message.pose.pose.position, message.twist.twist.linear
    assert (point.x, point.y, point.z) == pytest.approx((1.3, 2.4, 0.0), abs=1e-9)
    yaws = 0.5 + 0.6 * (1.0 - 0.001 * np.arange(10))
    ahead = np.mean(0.3 * np.cos(yaws) + 0.4 * np.sin(yaws))
    aside = np.mean(0.4 * np.cos(yaws) - 0.3 * np.sin(yaws))
    assert (linear.x, linear.y, linear.z) == pytest.approx((ahead, aside, 0))
    assert message.twist.twist.angular.z == pytest.approx(0.6)
    assert tf.latest.transforms[0].transform.translation.x == pytest.approx(1.3, abs=1e-9)


def test_in_three_dimensions_the_offset_of_the_base_frame_counts() -> None:
    offset = "<dimensions>3</dimensions><xyz_offset>0.5 0 0</xyz_offset><rpy_offset>0 0 1.5707963267948966</rpy_offset>"
    sim = load(offset + "<robot_base_frame>tool</robot_base_frame><odom_frame>map</odom_frame>")
    odometry = sim.subscribe("/model/m/odometry")
    sim.model("m").set_velocity((0, 0, 0.2), (0, 0, 2.0))
    sim.step(20)
    linear = odometry.latest.twist.twist.linear
    # 0.5 m · 2 rad/s to the left, which the turned base has ahead; the chord of a step lags by half of its turn
    assert (linear.x, linear.y, linear.z) == pytest.approx((1.0, -0.001, 0.2), abs=1e-6)
    assert odometry.latest.pose.pose.position.z == pytest.approx(3 + 0.2 * 0.02)
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("map", "tool")


def test_the_twist_is_the_mean_over_the_last_ten_steps() -> None:
    """At 2 m/s² the twist is 4.5 steps late; at the start it is the mean over fewer steps."""
    sim = load("<odom_publish_frequency>0</odom_publish_frequency>")
    odometry = sim.subscribe("/model/m/odometry")
    ahead = np.array((math.cos(0.5), math.sin(0.5), 0.0)) * 2.0
    for _ in range(30):
        sim.link("m::base").apply_wrench(ahead)
        sim.step()
    speeds = [m.twist.twist.linear.x for m in odometry.messages]
    assert len(speeds) == 30
    true = 0.002 * np.arange(1, 31)
    expected = [true[max(0, k - 9) : k + 1].mean() for k in range(30)]
    np.testing.assert_allclose(speeds, expected, atol=1e-9)


def test_a_late_subscriber_gets_the_same_messages() -> None:
    parameters = "<gaussian_noise>0.1</gaussian_noise>"
    early, late = load(parameters), load(parameters)
    early_messages = early.subscribe("/model/m/odometry")
    for sim in (early, late):
        sim.model("m").set_velocity((0.3, 0.4, 0.2), (0, 0, 0.6))
    early.run(1.0)
    late.run(0.99)
    last = late.subscribe("/model/m/odometry")
    late.run(0.01)
    assert last.latest.twist.twist == early_messages.latest.twist.twist


def test_noise_is_on_the_twist_and_its_variance_in_the_covariance() -> None:
    sim = load("<gaussian_noise>0.1</gaussian_noise><odom_publish_frequency>500</odom_publish_frequency>")
    odometry = sim.subscribe("/model/m/odometry_with_covariance")
    sim.run(2.0)
    xs = [m.twist.twist.linear.x for m in odometry.messages]
    assert len(xs) == 1000
    assert np.std(xs) == pytest.approx(0.1, rel=0.1)
    assert odometry.latest.twist.covariance[::7] == pytest.approx([0.01] * 6)


def test_dimensions_other_than_two_or_three_are_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        load("<dimensions>4</dimensions>")


def test_a_noise_with_an_infinite_square_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002.*gaussian_noise"):
        load("<gaussian_noise>1e300</gaussian_noise>")
