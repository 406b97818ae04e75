"""IMU: lever arms, rates, reference frames, and the plugin of Gazebo Classic."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sensor_worlds import noise, sensor, world, xyz

import simkit
from simkit.sensors.noise import NoiseModel

SPINNER = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m">
  <link name="base"><inertial><mass>1e6</mass>
    <inertia><ixx>1e6</ixx><iyy>1e6</iyy><izz>1e6</izz></inertia></inertial></link>
  <link name="arm"><sensor name="s" type="imu"><pose>0.5 0 0 0 0 1.5707963267948966</pose>
    <update_rate>0</update_rate><topic>i</topic></sensor></link>
  <joint name="j" type="revolute"><parent>base</parent><child>arm</child>
    <axis><xyz>0 0 1</xyz><dynamics><damping>DAMPING</damping></dynamics></axis></joint>
  </model></world></sdf>"""


def classic(plugin: str, noises: str = "") -> str:
    block = f"<imu>{noises}</imu>" + f'<plugin name="node" filename="libgazebo_ros_imu_sensor.so">{plugin}</plugin>'
    return world(sensor("imu", block), pose="0 0 0 0 0 0.5")


@pytest.mark.parametrize("damping", [0.0, 3.0])
def test_on_a_turning_arm_the_imu_measures_the_acceleration_at_its_position(damping: float) -> None:
    """The sensor is 0.5 m out and has a yaw of 90 degrees: inwards is its +y axis, along the rotation is its +x."""
    with simkit.load(SPINNER.replace("DAMPING", str(damping))) as sim:
        sim.joint("m::j").set_velocity(2.0)
        sub = sim.subscribe("/i")
        sim.step(20)
        speed = sim.joint("m::j").velocity
        along = -0.5 * damping * speed / 1.0  # the arm's moment of inertia is SDF's 1 kg m2
        np.testing.assert_allclose(xyz(sub.latest.angular_velocity), (0, 0, speed), atol=1e-6)
        np.testing.assert_allclose(xyz(sub.latest.linear_acceleration), (along, 0.5 * speed**2, 0), atol=2e-2)


def test_gz_orientation_is_relative_to_the_start_and_classics_to_the_world() -> None:
    with simkit.load(world(sensor("imu", "<imu/>"), pose="0 0 0 0 0 0.5")) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.orientation.w == pytest.approx(1.0)
        assert sim.sensor("m::l::s").topic == "/world/w/model/m/link/l/sensor/s/imu"
        assert sim.sensor("m::l::s").latest.header.frame_id == "m::l::s"
    with simkit.load(classic("")) as sim:
        sim.run(0.02)
        message = sim.sensor("m::l::s").latest
        assert message.orientation.z == pytest.approx(math.sin(0.25))
        assert message.header.frame_id == "l"
        assert "/node/out" in sim.topics()
        assert not [t for t in sim.topics() if t.startswith("/world/") and t not in sim.communication.bus.aside]
    with simkit.load(classic("<initial_orientation_as_reference>true</initial_orientation_as_reference>")) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.orientation.w == pytest.approx(1.0)


def test_classic_names_topic_and_frame() -> None:
    plugin = "<ros><namespace>/tb3</namespace><remapping>~/out:=imu</remapping></ros><frame_name>here</frame_name>"
    with simkit.load(classic(plugin)) as sim:
        sim.run(0.02)
        assert sim.topics()["/tb3/imu"] == "sensor_msgs/msg/Imu"
        assert sim.sensor("m::l::s").topic == "/tb3/imu"
        assert sim.sensor("m::l::s").latest.header.frame_id == "here"


def test_a_frame_of_the_file_is_not_changed() -> None:
    with simkit.load(world(sensor("imu", "<gz_frame_id>odd</gz_frame_id>"))) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.header.frame_id == "odd"


def test_reading_later_gives_the_same_as_reading_in_time() -> None:
    noises = f"<angular_velocity><x>{noise(0.1)}</x></angular_velocity>"
    with simkit.load(classic("", noises), seed=4) as early, simkit.load(classic("", noises), seed=4) as late:
        early.subscribe("/node/out")
        early.run(0.055)
        late.run(0.055)
        a, b = early.sensor("m::l::s").latest, late.sensor("m::l::s").latest
        assert a.header.stamp.nanosec == b.header.stamp.nanosec == 50_000_000
        assert a.angular_velocity.x == b.angular_velocity.x != 0
        assert xyz(a.linear_acceleration).tolist() == xyz(b.linear_acceleration).tolist()


def test_a_restored_run_repeats_its_noise() -> None:
    more = (
        "<dynamic_bias_stddev>0.2</dynamic_bias_stddev><dynamic_bias_correlation_time>1</dynamic_bias_correlation_time>"
    )
    noises = f"<angular_velocity><x>{noise(0.1, more=more)}</x></angular_velocity>"
    with simkit.load(classic("", noises), seed=4) as sim:
        sub = sim.subscribe("/node/out")
        sim.run(0.1)
        snapshot = sim.snapshot()
        sim.run(0.1)
        first = [m.angular_velocity.x for m in sub.messages][-10:]
        sim.restore(snapshot)
        sim.run(0.1)
        assert [m.angular_velocity.x for m in sub.messages][-10:] == first
        sim.reset()
        sim.run(0.2)
        assert [m.angular_velocity.x for m in sub.messages][-10:] == first


def test_added_noise_ends_with_a_reset_and_returns_with_a_snapshot() -> None:
    with simkit.load(SPINNER.replace("DAMPING", "0"), seed=4) as sim:
        imu, rates = sim.sensor("m::arm::s"), sim.subscribe("/i")
        imu.add_white_noise(5.0)
        imu.add_white_noise(0.1)
        sim.run(1.0)
        noisy = sim.snapshot()
        spread = np.std([m.angular_velocity.x for m in rates.messages])
        assert spread == pytest.approx(0.1, rel=0.1)
        sim.run(0.1)
        after = [m.angular_velocity.x for m in rates.messages][-100:]
        sim.reset()
        sim.run(0.1)
        assert [m.angular_velocity.x for m in rates.messages][-100:] == [0.0] * 100
        assert imu.latest.angular_velocity_covariance[0] == 0.0
        sim.restore(noisy)
        sim.run(0.1)
        assert [m.angular_velocity.x for m in rates.messages][-100:] == after


def test_options_keep_every_noise_parameter() -> None:
    more = (
        "<bias_mean>1</bias_mean><bias_stddev>2</bias_stddev><dynamic_bias_stddev>3</dynamic_bias_stddev>"
        "<dynamic_bias_correlation_time>4</dynamic_bias_correlation_time><precision>5</precision>"
    )
    with simkit.load(
        world(sensor("imu", f"<imu><angular_velocity><y>{noise(6, 7, more)}</y></angular_velocity></imu>"))
    ) as sim:
        assert sim.sensor("m::l::s").options.angular_velocity[1] == NoiseModel(7, 6, 1, 2, 3, 4, 5)


def test_a_slower_rate_can_be_set() -> None:
    with simkit.load(world(sensor("imu", "<imu/>"))) as sim:
        sub = sim.subscribe("/world/w/model/m/link/l/sensor/s/imu")
        sim.sensor("m::l::s").set_rate(20)
        sim.run(0.5)
        assert 10 <= len(sub.messages) <= 11
        with pytest.raises(ValueError, match="at least 0"):
            sim.sensor("m::l::s").set_rate(math.nan)


def test_unread_messages_do_not_change_when_the_model_is_moved() -> None:
    with simkit.load(world(sensor("imu", "<imu/>", extra="<topic>i</topic>"), pose="0 0 1 0.3 0 0")) as sim:
        sub = sim.subscribe("/i")
        sim.run(0.05)
        sim.model("m").set_pose(simkit.Pose((0, 0, 2)))
        sim.run(0.05)
        np.testing.assert_allclose(xyz(sub.messages[0].linear_acceleration)[1], 9.8 * math.sin(0.3), atol=1e-9)
        np.testing.assert_allclose(xyz(sub.latest.linear_acceleration), (0, 0, 9.8), atol=1e-9)
