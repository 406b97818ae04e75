"""Sensors of RotorS: IMU, odometry, air pressure, magnetic field and GPS, and the speeds of the rotors."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

SILENT = "".join(
    f"<{kind}{name}>0</{kind}{name}>"
    for kind, names in (
        ("gyroscope", ("NoiseDensity", "RandomWalk", "TurnOnBiasSigma")),
        ("accelerometer", ("NoiseDensity", "RandomWalk", "TurnOnBiasSigma")),
    )
    for name in names
)


def world(*plugins: str, gps: str = "", gravity: float = -9.8) -> str:
    return f"""<sdf version="1.6"><world name="w"><gravity>0 0 {gravity}</gravity>
      <spherical_coordinates><latitude_deg>47.3667</latitude_deg><longitude_deg>8.55</longitude_deg>
        <elevation>500</elevation></spherical_coordinates>
      <model name="firefly"><pose>1 2 3 0 0 0</pose><link name="firefly/base_link"><inertial><pose>0 0 0.1 0 0 0</pose>
        <mass>1.5</mass><inertia><ixx>0.03</ixx><iyy>0.03</iyy><izz>0.05</izz></inertia></inertial>{gps}</link>
      <link name="firefly/rotor_0"><inertial><mass>0.005</mass><inertia><ixx>1e-5</ixx><iyy>1e-5</iyy><izz>2e-5</izz>
        </inertia></inertial></link>
      <joint name="firefly/rotor_0_joint" type="continuous"><parent>firefly/base_link</parent>
        <child>firefly/rotor_0</child><axis><xyz>0 0 1</xyz></axis></joint>{"".join(plugins)}</model></world></sdf>"""


def sensor(kind: str, more: str = "") -> str:
    return f"""<plugin name="{kind}" filename="librotors_gazebo_{kind}_plugin.so">
      <robotNamespace>firefly</robotNamespace><linkName>firefly/base_link</linkName>{more}</plugin>"""


def test_an_imu_measures_turning_rate_and_specific_force() -> None:
    with simkit.load(world(sensor("imu", SILENT), gravity=0)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        imu = sim.subscribe("/firefly/imu", keep=1)
        base = sim.link("firefly::firefly/base_link")
        base.set_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 2.0))
        base.apply_wrench((3.0, 0.0, 0.0))
        sim.step(1)
        last = imu.messages[-1]
        assert last.angular_velocity.z == pytest.approx(2.0, rel=1e-3)
        assert last.linear_acceleration.x == pytest.approx(2.0, rel=0.02)
        assert last.header.frame_id == "firefly/base_link"
        assert last.orientation_covariance[0] == -1


def test_the_noise_of_an_imu_has_the_density_of_the_file_and_follows_the_seed() -> None:
    density = 0.01
    noisy = SILENT.replace("<gyroscopeNoiseDensity>0<", f"<gyroscopeNoiseDensity>{density}<")

    def readings(seed: int) -> list[float]:
        with simkit.load(world(sensor("imu", noisy)), seed=seed) as sim:
            imu = sim.subscribe("/firefly/imu", keep=2000)
            sim.step(2000)
            return [m.angular_velocity.x for m in imu.messages]

    first = readings(1)
    assert np.std(first) == pytest.approx(density / math.sqrt(1e-3), rel=0.08)  # 2000 samples
    assert readings(1) == first != readings(2)


def test_odometry_has_the_pose_of_the_centre_of_mass_on_all_topics_and_a_delay() -> None:
    more = "<odometryTopic>sensor/odometry</odometryTopic><measurementDivisor>10</measurementDivisor>"
    more += (
        "<measurementDelay>5</measurementDelay><unknownDelay>0.5</unknownDelay><childFrameId>firefly/odo</childFrameId>"
    )
    with simkit.load(world(sensor("odometry", more), gravity=0)) as sim:
        names = ("sensor/odometry", "pose", "pose_with_covariance", "position", "transform")
        got = {name: sim.subscribe(f"/firefly/{name}", keep=10) for name in names}
        frames = sim.subscribe("/tf", keep=1)
        sim.link("firefly::firefly/base_link").set_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        sim.step(16)
        assert {len(topic.messages) for topic in got.values()} == {1}
        odometry = got["sensor/odometry"].messages[0]
        assert odometry.header.stamp.sec * 10**9 + odometry.header.stamp.nanosec == 510_000_000
        assert odometry.child_frame_id == "firefly/odo"
        place = odometry.pose.pose.position
        assert (place.x, place.y, place.z) == pytest.approx((1.01, 2.0, 3.1), abs=1e-3)
        assert odometry.twist.twist.linear.x == pytest.approx(1.0, rel=1e-3)
        assert got["position"].messages[0].point.z == pytest.approx(3.1, abs=1e-6)
        assert frames.messages[-1].transforms[0].child_frame_id == "firefly/odo"


def test_noise_of_the_odometry_has_the_covariance_of_the_message() -> None:
    more = (
        "<noiseNormalPosition>0.1 0.1 0.1</noiseNormalPosition><noiseNormalQuaternion>0 0 0.02</noiseNormalQuaternion>"
    )
    with simkit.load(world(sensor("odometry", more), gravity=0)) as sim:
        odometry = sim.subscribe("/firefly/odometry", keep=1000)
        sim.step(1000)
        assert np.std([m.pose.pose.position.y for m in odometry.messages]) == pytest.approx(0.1, rel=0.1)
        yaw = [2 * m.pose.pose.orientation.z for m in odometry.messages]
        assert np.std(yaw) == pytest.approx(0.02, rel=0.1)
        assert odometry.messages[0].pose.covariance[0] == pytest.approx(0.01)


def test_pressure_and_magnetic_field_are_those_of_the_place() -> None:
    with simkit.load(world(sensor("pressure"), sensor("magnetometer"), gravity=0)) as sim:
        pressure, field = (
            sim.subscribe("/firefly/air_pressure", keep=1),
            sim.subscribe("/firefly/magnetic_field", keep=1),
        )
        sim.step(1)
        assert pressure.messages[-1].fluid_pressure == pytest.approx(95461 - 3 * 11.4, abs=5)  # ISA at 500 m
        assert field.messages[-1].magnetic_field.x == pytest.approx(0.000021493)


def test_gps_has_the_place_and_the_speed_over_ground() -> None:
    quiet = "<horVelStdDev>0</horVelStdDev><verVelStdDev>0</verVelStdDev>"
    gps = f"""<sensor name="gps" type="gps"><update_rate>5</update_rate>{sensor("gps", quiet)}</sensor>"""
    with simkit.load(world(gps=gps, gravity=0)) as sim:
        fix, speed = sim.subscribe("/firefly/gps", keep=9), sim.subscribe("/firefly/ground_speed", keep=9)
        sim.link("firefly::firefly/base_link").set_velocity((0.5, 0.0, 0.0))
        sim.run(1.001)
        assert len(speed.messages) == 5
        assert speed.messages[-1].twist.linear.x == pytest.approx(0.5)
        assert fix.messages[-1].latitude == pytest.approx(47.3667, abs=1e-4)


def test_the_base_publishes_the_speeds_of_the_rotors() -> None:
    with simkit.load(
        world(sensor("multirotor_base", "<rotorVelocitySlowdownSim>20</rotorVelocitySlowdownSim>"))
    ) as sim:
        speeds, joints = sim.subscribe("/firefly/motor_speed", keep=1), sim.subscribe("/firefly/joint_states", keep=1)
        sim.joint("firefly::firefly/rotor_0_joint").set_velocity(3.0)
        sim.step(1)
        assert list(speeds.messages[-1].angular_velocities) == pytest.approx([60.0], rel=1e-2)
        assert list(joints.messages[-1].name) == ["firefly/rotor_0_joint"]
