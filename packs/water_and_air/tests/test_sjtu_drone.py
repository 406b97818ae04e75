"""Drone of sjtu_drone: takeoff, velocities, positions, landing, and its topics in ROS 2 and ROS 1."""

from __future__ import annotations

import math

import pytest

import simkit

GAINS = """<rollpitchProportionalGain>10</rollpitchProportionalGain>
  <rollpitchDifferentialGain>5</rollpitchDifferentialGain><rollpitchLimit>0.5</rollpitchLimit>
  <yawProportionalGain>2</yawProportionalGain><yawLimit>1.5</yawLimit>
  <velocityXYProportionalGain>5</velocityXYProportionalGain>
  <velocityXYDifferentialGain>2.3</velocityXYDifferentialGain><velocityXYLimit>2</velocityXYLimit>
  <positionXYProportionalGain>1.1</positionXYProportionalGain>
  <positionXYDifferentialGain>0</positionXYDifferentialGain><positionXYLimit>5</positionXYLimit>
  <positionZProportionalGain>1</positionZProportionalGain>
  <positionZDifferentialGain>0.2</positionZDifferentialGain><maxForce>30</maxForce>"""
ROS_2 = "<ros><namespace>/drone</namespace></ros><pub_odom>true</pub_odom>"


def world(more: str = ROS_2, gains: str = GAINS) -> str:
    return f"""<sdf version="1.6"><world name="w"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
      <model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
      </collision></link></model>
      <model name="quad"><pose>0 0 0.1 0 0 0</pose><link name="base_link"><inertial><mass>1.477</mass>
        <inertia><ixx>0.1152</ixx><iyy>0.1152</iyy><izz>0.218</izz></inertia></inertial>
        <collision name="c"><geometry><box><size>0.6 0.6 0.2</size></box></geometry></collision></link>
      <plugin name="simple_drone" filename="libplugin_drone.so"><bodyName>base_link</bodyName>{more}{gains}</plugin>
      </model></world></sdf>"""


def command(sim: simkit.Simulation, x: float = 0, y: float = 0, z: float = 0, yaw: float = 0) -> None:
    twist = {"linear": {"x": float(x), "y": float(y), "z": float(z)}, "angular": {"z": float(yaw)}}
    sim.publish("/drone/cmd_vel", twist)


def test_the_drone_takes_off_flies_at_commanded_velocities_and_lands() -> None:
    with simkit.load(world()) as sim:
        assert not list(sim.diagnostics)
        state, base = sim.subscribe("/drone/state", keep=1), sim.link("quad::base_link")
        command(sim, z=1)
        sim.run(1.0)
        assert state.messages[-1].data == 0
        assert base.pose.position[2] == pytest.approx(0.1, abs=1e-3)  # the command alone does not start the flight
        sim.publish("/drone/takeoff", {})
        sim.run(0.4)
        assert state.messages[-1].data == 2
        sim.run(2.0)
        assert state.messages[-1].data == 1
        assert base.linear_velocity == pytest.approx([0, 0, 1], abs=0.01)
        command(sim, x=1, yaw=0.5)
        sim.run(4.0)
        assert base.angular_velocity[2] == pytest.approx(0.5, abs=0.01)
        assert math.hypot(*base.linear_velocity[:2]) == pytest.approx(1.0, abs=0.05)
        command(sim, x=1)
        sim.run(4.0)
        velocity = base.linear_velocity
        assert math.atan2(velocity[1], velocity[0]) == pytest.approx(base.pose.rpy[2], abs=0.02)
        command(sim)
        sim.run(4.0)
        assert base.linear_velocity == pytest.approx([0, 0, 0], abs=0.01)
        sim.publish("/drone/land", {})
        sim.run(0.5)
        assert state.messages[-1].data == 3
        sim.run(3.0)
        assert state.messages[-1].data == 0
        assert base.pose.position[2] == pytest.approx(0.1, abs=1e-3)


def test_position_control_flies_to_a_point_of_the_world() -> None:
    with simkit.load(world()) as sim:
        odometry, pose = sim.subscribe("/drone/odom", keep=1), sim.subscribe("/drone/gt_pose", keep=1)
        sim.publish("/drone/takeoff", {})
        command(sim, yaw=0.5)
        sim.run(2.0)
        sim.publish("/drone/posctrl", {"data": True})
        command(sim, x=2, y=-1, z=3)
        sim.run(10.0)
        place = sim.link("quad::base_link").pose.position
        assert place == pytest.approx([2, -1, 3], abs=0.02)
        assert pose.messages[-1].position.z == pytest.approx(place[2], abs=1e-6)
        last = odometry.messages[-1]
        assert (last.header.frame_id, last.child_frame_id) == ("drone/odom", "drone/base_footprint")
        assert last.pose.pose.position.x == pytest.approx(place[0], abs=1e-3)


def test_velocity_and_acceleration_are_in_the_axes_of_the_drone() -> None:
    with simkit.load(world()) as sim:
        speed, mode = sim.subscribe("/drone/gt_vel", keep=1), sim.subscribe("/drone/cmd_mode", keep=1)
        gained = sim.subscribe("/drone/gt_acc", keep=1)
        sim.publish("/drone/takeoff", {})
        command(sim, yaw=1)
        sim.run(math.pi / 2)
        command(sim, x=1)
        sim.publish("/drone/dronevel_mode", {"data": True})
        sim.run(6.0)
        assert speed.messages[-1].linear.x == pytest.approx(1.0, abs=0.02)
        assert speed.messages[-1].linear.y == pytest.approx(0.0, abs=0.02)
        assert gained.messages[-1].linear.x == pytest.approx(0.0, abs=0.02)
        assert mode.messages[-1].data == "velocity"


def test_a_file_of_ros_1_has_the_topics_of_ros_1() -> None:
    with simkit.load(world("<imuTopic>/drone/imu</imuTopic>")) as sim:
        sim.publish("/drone/takeoff", {})
        sim.publish("/cmd_vel", {"linear": {"z": 0.5}})
        sim.run(3.0)
        assert sim.link("quad::base_link").linear_velocity[2] == pytest.approx(0.5, abs=0.01)


def test_noise_of_the_commands_follows_the_seed_and_a_reset_repeats_it() -> None:
    noise = "<motionSmallNoise>0.2</motionSmallNoise><motionDriftNoise>0.1</motionDriftNoise>"
    drift = "<motionDriftNoiseTime>0.1</motionDriftNoiseTime>"

    def height(sim: simkit.Simulation) -> float:
        sim.publish("/drone/takeoff", {})
        for _ in range(20):
            command(sim, z=0.5)
            sim.run(0.1)
        return float(sim.link("quad::base_link").pose.position[2])

    def flown(seed: int) -> float:
        with simkit.load(world(ROS_2 + noise + drift), seed=seed) as sim:
            first = height(sim)
            sim.reset()
            assert height(sim) == first
            return first

    assert flown(1) == flown(1) != flown(2)


def test_a_restored_flight_goes_on_with_the_same_bits() -> None:
    with simkit.load(world()) as sim:
        sim.publish("/drone/takeoff", {})
        command(sim, x=0.5, z=0.3)
        sim.run(1.0)
        saved = sim.snapshot()
        sim.run(1.0)
        expected = sim.link("quad::base_link").pose.position.tolist()
        sim.restore(saved)
        sim.run(1.0)
        assert sim.link("quad::base_link").pose.position.tolist() == expected


def test_an_unknown_body_is_reported_at_its_line() -> None:
    report = simkit.check(world().replace("<bodyName>base_link", "<bodyName>base"))
    assert any(d.code == "SK-PLUGIN-003" and "'base'" in d.message for d in report)
