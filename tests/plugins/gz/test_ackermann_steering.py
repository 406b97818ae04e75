"""Ackermann steering of Gazebo."""

from __future__ import annotations

import math

import pytest
from car_worlds import BASE, TRACK, car, world

import simkit


def plugin(settings=""):
    return f"""<plugin filename="gz-sim-ackermann-steering-system" name="gz::sim::systems::AckermannSteering">
  <left_joint>rl_joint</left_joint><right_joint>rr_joint</right_joint>
  <left_steering_joint>fl_steering</left_steering_joint><right_steering_joint>fr_steering</right_steering_joint>
  <wheel_base>{BASE}</wheel_base><wheel_separation>{TRACK}</wheel_separation><kingpin_width>{TRACK}</kingpin_width>
  <wheel_radius>0.1</wheel_radius><steering_limit>0.5</steering_limit><steer_p_gain>20</steer_p_gain>{settings}</plugin>"""


def only(settings=""):
    return f"""<plugin filename="gz-sim-ackermann-steering-system" name="gz::sim::systems::AckermannSteering">
  <steering_only>true</steering_only><left_steering_joint>fl_steering</left_steering_joint>
  <right_steering_joint>fr_steering</right_steering_joint><wheel_base>{BASE}</wheel_base>
  <wheel_separation>{TRACK}</wheel_separation><steer_p_gain>20</steer_p_gain>{settings}</plugin>"""


def angles(sim):
    return tuple(sim.joint(f"car::{name}_steering").position for name in ("fl", "fr"))


def ackermann(radius):
    return math.atan(BASE / (radius - TRACK / 2)), math.atan(BASE / (radius + TRACK / 2))


def drive(sim, forward, turn, duration):
    sim.publish("/model/car/cmd_vel", {"linear": {"x": forward}, "angular": {"z": turn}})
    sim.run(duration)


def test_all_wheels_turn_around_the_centre_of_the_circle():
    sim = simkit.load(world(car(plugin())))
    drive(sim, 0.5, 0.25, 2.0)
    assert angles(sim) == pytest.approx(ackermann(2.0), abs=2e-3)
    rear = [sim.joint(f"car::{name}_joint").velocity for name in ("rl", "rr")]
    assert rear == pytest.approx([0.5 * (1 - TRACK / 4) / 0.1, 0.5 * (1 + TRACK / 4) / 0.1], rel=5e-3)
    before = sim.model("car").pose
    sim.run(2.0)
    moved = before.inverse() @ sim.model("car").pose
    assert moved.rpy[2] == pytest.approx(0.5, rel=0.02)
    assert sim.link("car::base").angular_velocity[2] == pytest.approx(0.25, rel=0.02)


@pytest.mark.parametrize("turn", [3.0, -3.0])
def test_the_steering_angle_does_not_exceed_its_limit(turn):
    """The tightest circle has a radius of wheel base / sin(limit)."""
    sim = simkit.load(world(car(plugin())))
    drive(sim, 0.3, turn, 1.5)
    radius = math.copysign(BASE / math.sin(0.5), turn)
    assert angles(sim) == pytest.approx(ackermann(radius), abs=5e-3)


def test_backwards_it_steers_the_other_way_and_turns_as_commanded():
    sim = simkit.load(world(car(plugin())))
    drive(sim, -0.4, 0.2, 2.0)
    assert angles(sim) == pytest.approx(ackermann(-2.0), abs=5e-3)
    assert sim.link("car::base").angular_velocity[2] == pytest.approx(0.2, rel=0.03)


def test_at_zero_speed_it_steers_and_a_turning_rate_below_a_thousandth_is_straight():
    sim = simkit.load(world(car(plugin())))
    drive(sim, 0.0, 0.5, 1.5)
    assert angles(sim) == pytest.approx(ackermann(BASE / math.sin(0.5)), abs=0.01)
    drive(sim, 0.5, 0.0009, 1.5)
    assert angles(sim) == pytest.approx((0.0, 0.0), abs=2e-3)


def test_odometry_is_of_the_middle_of_the_rear_axle():
    sim = simkit.load(world(car(plugin("<odom_publish_frequency>25</odom_publish_frequency>"))))
    odometry, tf = sim.subscribe("/model/car/odometry"), sim.subscribe("/model/car/tf")
    drive(sim, 0.5, 0.25, 4.0)
    message, base = odometry.messages[-1], sim.model("car").pose
    x, y, yaw = *base.position[:2], base.rpy[2]
    # from the middle of the car to that of its rear axle, which began at -BASE/2
    axle = (x - BASE / 2 * math.cos(yaw) + BASE / 2, y - BASE / 2 * math.sin(yaw))
    estimated = message.pose.pose.position
    assert (estimated.x, estimated.y) == pytest.approx(axle, abs=0.03)
    assert message.twist.twist.linear.x == pytest.approx(0.5, rel=0.02)
    assert message.twist.twist.angular.z == pytest.approx(0.25, rel=0.02)
    assert message.header.frame_id == "car/odom" and message.child_frame_id == "car/base"
    assert len(odometry.messages) == len(tf.messages) == 100


def test_speed_and_acceleration_stay_within_their_limits():
    limits = "<max_acceleration>0.5</max_acceleration><max_velocity>0.3</max_velocity>"
    sim = simkit.load(world(car(plugin(limits))))
    drive(sim, 1.0, 0.0, 0.4)
    assert sim.joint("car::rl_joint").velocity * 0.1 == pytest.approx(0.2, abs=0.01)
    sim.run(1.0)
    assert sim.joint("car::rl_joint").velocity * 0.1 == pytest.approx(0.3, abs=0.005)


def test_steering_only_follows_an_angle():
    """Left and right follow from the angle of a wheel in the middle; the limit is 0.5 rad."""
    sim = simkit.load(world(car(only())))
    for command, angle in ((0.25, 0.25), (1.5, 0.5), (-0.3, -0.3)):
        sim.publish("/model/car/steer_angle", {"data": command})
        sim.run(1.0)
        assert angles(sim) == pytest.approx(ackermann(BASE / math.tan(angle)), abs=2e-3)
    assert "/model/car/odometry" not in sim.topics()


def test_steering_only_by_a_message_of_actuators(caplog):
    sim = simkit.load(world(car(only("<use_actuator_msg>true</use_actuator_msg><actuator_number>1</actuator_number>"))))
    sim.publish("/actuators", {"position": [9.0, 0.2]})
    sim.run(1.0)
    assert angles(sim) == pytest.approx(ackermann(BASE / math.tan(0.2)), abs=2e-3)
    sim.publish("/actuators", {"position": [9.0]})
    sim.run(0.1)
    assert "it has no index 1" in caplog.text


def test_sub_topics_and_topics():
    for settings, topic in (("<sub_topic>go</sub_topic>", "/model/car/go"), ("<topic>drive/it</topic>", "/drive/it")):
        sim = simkit.load(world(car(plugin(settings))))
        sim.publish(topic, {"linear": {"x": 0.5}})
        sim.run(0.5)
        assert sim.model("car").pose.position[0] > 0.15


def test_the_gain_is_a_live_parameter():
    sim = simkit.load(world(car(only())))
    (node,) = [name for name, own in sim.communication.parameters.items() if "steer_p_gain" in own]
    sim.set_parameter(node, "steer_p_gain", 1.0)
    sim.publish("/model/car/steer_angle", {"data": 0.3})
    sim.run(1.0)
    assert angles(sim)[0] == pytest.approx(ackermann(BASE / math.tan(0.3))[0] * (1 - math.exp(-1)), rel=0.02)


def test_all_errors_are_reported_together():
    wrong = (
        plugin("<steering_limit>3</steering_limit>")
        .replace("fl_steering", "fl_stering")
        .replace("<right_joint>rr_joint</right_joint>", "")
        .replace("<steering_limit>0.5</steering_limit>", "")
    )
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(car(wrong)))
    for part in ("fl_stering", "fl_steering", "<steering_limit>", "<right_joint>"):
        assert part in str(caught.value)


def test_a_reset_restores_the_initial_state():
    sim = simkit.load(world(car(plugin())))
    drive(sim, 0.5, 0.25, 0.5)
    here = sim.mj_data.qpos.tobytes()
    sim.reset()
    drive(sim, 0.5, 0.25, 0.5)
    assert sim.mj_data.qpos.tobytes() == here
