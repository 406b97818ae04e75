"""IMU plugin of ROS 1 on a model: readings, names, and Gazebo's quirks."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from plugin_worlds import element, stamps, world, xyz

import simkit
from simkit import Pose

G = 9.8
QUIRKS = "<simkit:gazebo_quirks>true</simkit:gazebo_quirks>"
POST = (
    "<link name='head'><pose>{pose}</pose><inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz>"
    "</inertia></inertial></link>"
)


def imu(**values: Any) -> str:
    settings = {"bodyName": "head", "topicName": "imu", **values}
    return element("plugin", settings, "name='imu' filename='libgazebo_ros_imu.so'")


def fixed(plugin: str, pose: str = "0 0 1 0 0 0", top: str = "") -> str:
    """Return a head that is fixed to the world."""
    joint = "<joint name='foot' type='fixed'><parent>world</parent><child>head</child></joint>"
    return world(top, f"<model name='post'>{POST.format(pose=pose)}{joint}{plugin}</model>")


def wheel(plugin: str, pose: str = "1 0 0 0 0 0", top: str = "") -> str:
    """Return a head 1 m off a vertical axle in the world."""
    joint = (
        "<joint name='axle' type='revolute'><pose relative_to='__model__'/><parent>world</parent><child>head</child>"
        "<axis><xyz expressed_in='__model__'>0 0 1</xyz></axis></joint>"
    )
    return world(top, f"<model name='wheel'>{POST.format(pose=pose)}{joint}{plugin}</model>")


def first(sim: simkit.Simulation, topic: str = "/imu", seconds: float = 0.001) -> list[Any]:
    subscription = sim.subscribe(topic)
    sim.run(seconds)
    return list(subscription.messages)


def turn(message: Any) -> Pose:
    q = message.orientation
    return Pose((0, 0, 0), (q.w, q.x, q.y, q.z))


def test_at_rest_the_imu_measures_gravity_in_its_axes_and_its_attitude() -> None:
    with simkit.load(fixed(imu(updateRate=50), pose="0 0 1 0.3 -0.2 0.5")) as sim:
        assert sim.topics()["/imu"] == "sensor_msgs/msg/Imu"
        messages = first(sim, seconds=0.1)
        assert stamps(messages).tolist() == [20_000_000 * k for k in range(1, 6)]
        message = messages[-1]
        attitude = Pose.from_rpy(0, 0, 0, 0.3, -0.2, 0.5)
        assert message.header.frame_id == "head"
        np.testing.assert_allclose(xyz(message.linear_acceleration), attitude.matrix.T @ (0, 0, G), atol=1e-9)
        np.testing.assert_allclose(xyz(message.angular_velocity), 0, atol=1e-9)
        np.testing.assert_allclose(turn(message).matrix, attitude.matrix, atol=1e-9)
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        assert "SK-PLUGIN-060" in {d.code for d in sim.diagnostics}


def test_on_a_circle_the_imu_measures_the_centripetal_acceleration() -> None:
    """The acceleration is ω² r towards the axle [m/s²], for every orientation of the head."""
    with simkit.load(wheel(imu(), pose="1 0 0 0 0 0.7")) as sim:
        sim.joint("wheel::axle").set_velocity(3.0)
        message = first(sim)[0]
        look = turn(message).matrix
        np.testing.assert_allclose(xyz(message.angular_velocity), (0, 0, 3), atol=1e-6)
        inwards = -(look.T @ np.array(sim.link("wheel::head").pose.position))
        np.testing.assert_allclose(xyz(message.linear_acceleration), 9 * inwards + (0, 0, G), atol=1e-6)


def test_in_free_fall_the_acceleration_is_zero() -> None:
    with simkit.load(world(f"<model name='stone'>{POST.format(pose='0 0 9 0 0 0')}{imu()}</model>")) as sim:
        np.testing.assert_allclose(xyz(first(sim)[0].linear_acceleration), 0, atol=1e-9)


def test_with_gazebo_quirks_gravity_is_omitted_and_vectors_turn_in_the_wrong_direction() -> None:
    with simkit.load(wheel(imu(), pose="1 0 0 0 0 0.7", top=QUIRKS)) as sim:
        sim.joint("wheel::axle").set_velocity(3.0)
        message = first(sim)[0]
        inwards = -np.array(sim.link("wheel::head").pose.position)
        np.testing.assert_allclose(xyz(message.linear_acceleration), 9 * turn(message).matrix @ inwards, atol=1e-6)
        assert "SK-PLUGIN-060" not in {d.code for d in sim.diagnostics}


def test_names_and_offsets_are_as_in_the_file() -> None:
    settings = {"robotNamespace": "tb", "frameName": "/chip", "rpyOffset": "0 0 0.4", "xyzOffset": "1 0 0"}
    with simkit.load(fixed(imu(serviceName="calibrate", **settings), pose="0 0 1 0 0 0.1")) as sim:
        message = first(sim, "/tb/imu")[0]
        assert message.header.frame_id == "chip"
        assert 2 * math.atan2(message.orientation.z, message.orientation.w) == pytest.approx(0.5)
        assert sim.communication.services.names()["/tb/calibrate"] == "std_srvs/srv/Empty"
        sim.call("/tb/calibrate", {})
        assert "SK-SENSOR-072" in {d.code for d in sim.diagnostics}


def test_missing_parameters_have_gazebos_defaults() -> None:
    with simkit.load(fixed(imu(topicName=None))) as sim:
        messages = first(sim, "/default_imu", 0.01)
        assert len(messages) == 10
        assert "/default_imu" in sim.communication.services.names()
        np.testing.assert_array_equal(messages[0].angular_velocity_covariance, np.zeros(9))


def test_two_imus_of_one_robot_share_the_default_service() -> None:
    both = "".join(
        f"<model name='{name}'>{POST.format(pose=f'0 {y} 9 0 0 0')}{imu()}</model>" for name, y in (("a", 0), ("b", 9))
    )
    with simkit.load(world(both)) as sim:
        assert len(first(sim)) == 2


def test_noise_is_on_all_six_and_its_square_in_the_covariances() -> None:
    with simkit.load(fixed(imu(gaussianNoise=0.5)), seed=3) as sim:
        messages = first(sim, seconds=2.0)
        felt = np.array([(*xyz(m.angular_velocity), *xyz(m.linear_acceleration)) for m in messages])
        np.testing.assert_allclose(felt.std(axis=0), 0.5, rtol=0.06)  # 3.8 deviations of the estimate
        np.testing.assert_allclose(felt.mean(axis=0), (0, 0, 0, 0, 0, G), atol=0.045)
        assert abs(np.corrcoef(felt.T) - np.eye(6)).max() < 0.1
        for name in ("orientation", "angular_velocity", "linear_acceleration"):
            found = getattr(messages[0], f"{name}_covariance")
            np.testing.assert_allclose(found, np.diag([0.25] * 3).reshape(9), atol=1e-12)


def test_a_late_subscriber_gets_the_same_noise() -> None:
    def last(late: bool) -> str:
        with simkit.load(fixed(imu(gaussianNoise=0.5)), seed=3) as sim:
            if late:
                sim.run(0.05)
                return repr(first(sim, seconds=0.05)[-1])
            return repr(first(sim, seconds=0.1)[-1])

    assert last(late=True) == last(late=False)


def test_a_body_may_be_named_with_its_model() -> None:
    with simkit.load(fixed(imu(bodyName="post::head"))) as sim:
        assert first(sim)[0].header.frame_id == "head"


def test_a_missing_or_unknown_body_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*bodyName"):
        simkit.load(fixed(imu(bodyName=None)))
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003(.|\n)*did you mean 'head'"):
        simkit.load(fixed(imu(bodyName="haed")))
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*no link ''"):
        simkit.load(fixed(imu(bodyName="")))
