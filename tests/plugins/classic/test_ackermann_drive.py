"""Ackermann drive of Gazebo Classic."""

from __future__ import annotations

import math

import pytest
from car_worlds import BASE, TRACK, car, world

import simkit


def plugin(settings=""):
    """Return a car whose gains are those of efforts in one step of ten."""
    joints = "".join(
        f"<{ours}>{own}</{ours}>"
        for ours, own in (
            ("front_left_joint", "fl_joint"),
            ("front_right_joint", "fr_joint"),
            ("rear_left_joint", "rl_joint"),
            ("rear_right_joint", "rr_joint"),
            ("left_steering_joint", "fl_steering"),
            ("right_steering_joint", "fr_steering"),
        )
    )
    gains = "".join(f"<{side}_steering_pid_gain>15 0 1</{side}_steering_pid_gain>" for side in ("left", "right"))
    return f"""<plugin filename="libgazebo_ros_ackermann_drive.so" name="drive">{joints}{gains}
  <linear_velocity_pid_gain>2 1 0</linear_velocity_pid_gain><linear_velocity_i_range>-20 20</linear_velocity_i_range>
  <update_rate>0</update_rate><publish_odom>true</publish_odom><publish_odom_tf>true</publish_odom_tf>{settings}</plugin>"""


def drive(sim, speed, angle, duration):
    sim.publish("/cmd_vel", {"linear": {"x": speed}, "angular": {"z": angle}})
    sim.run(duration)


def test_a_steering_angle_gives_a_circle():
    sim = simkit.load(
        world(car(plugin("<publish_distance>true</publish_distance><publish_steerangle>1</publish_steerangle>")))
    )
    distance, angle = sim.subscribe("/distance"), sim.subscribe("/steerangle")
    odometry = sim.subscribe("/odom")
    drive(sim, 0.5, 0.3, 4.0)
    radius = BASE / math.tan(0.3)
    wanted = math.atan(BASE / (radius - TRACK / 2)), math.atan(BASE / (radius + TRACK / 2))
    found = [sim.joint(f"car::{name}_steering").position for name in ("fl", "fr")]
    assert found == pytest.approx(wanted, abs=0.01)
    speed = sim.joint("car::rr_joint").velocity * 0.1
    assert speed == pytest.approx(0.5, abs=0.02)
    assert sim.link("car::base").angular_velocity[2] == pytest.approx(0.5 / radius, rel=0.1)
    assert angle.messages[-1].data == pytest.approx(sum(found) / 2, abs=1e-3)
    assert 1.4 < distance.messages[-1].data < 2.1
    published, at = odometry.messages[-1].pose.pose.position, sim.model("car").pose.position
    assert (published.x, published.y, published.z) == pytest.approx(tuple(at), abs=1e-6)


def test_the_angle_is_reversed_when_driving_backwards_and_both_are_limited():
    sim = simkit.load(world(car(plugin("<max_steer>0.2</max_steer><max_speed>0.3</max_speed>"))))
    drive(sim, -5.0, 1.0, 3.0)
    radius = BASE / math.tan(0.2)
    assert sim.joint("car::fl_steering").position == pytest.approx(-math.atan(BASE / (radius + TRACK / 2)), abs=0.01)
    assert sim.joint("car::rr_joint").velocity * 0.1 == pytest.approx(-0.3, abs=0.02)


def test_without_gains_nothing_moves_and_the_steering_wheel_is_optional():
    bare = plugin().replace("15 0 1", "0 0 0").replace("2 1 0", "0 0 0")
    sim = simkit.load(world(car(bare)))
    drive(sim, 0.5, 0.3, 0.5)
    assert abs(sim.model("car").pose.position[0]) < 1e-3
    assert not [d for d in sim.diagnostics if d.severity == "error"]


def test_a_steering_wheel_that_the_car_does_not_have_is_a_warning():
    sim = simkit.load(world(car(plugin("<steering_wheel_joint>wheel_of_a_bus</steering_wheel_joint>"))))
    drive(sim, 0.5, 0.0, 2.0)
    assert sim.model("car").pose.position[0] > 0.3
    assert [d.code for d in sim.diagnostics if "wheel_of_a_bus" in d.message] == ["SK-PLUGIN-124"]


def test_a_car_that_cannot_be_measured_is_refused():
    text = world(car(plugin())).replace("<sphere><radius>0.1</radius></sphere>", "<box><size>0.2 0.2 0.2</size></box>")
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(text)
    assert "SK-PLUGIN-093" in str(caught.value)


def test_a_missing_joint_is_an_error_with_its_name():
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(car(plugin("").replace("rr_joint", "rear_joint"))))
    assert "'rear_joint'" in str(caught.value)


def test_a_reset_returns_to_the_start():
    sim = simkit.load(world(car(plugin())))
    drive(sim, 0.5, 0.2, 0.5)
    here = sim.mj_data.qpos.tobytes()
    sim.reset()
    drive(sim, 0.5, 0.2, 0.5)
    assert sim.mj_data.qpos.tobytes() == here


def test_a_rate_above_that_of_steps_is_every_step():
    """The first update has no earlier time: its derivative uses a step, not the shorter period of the rate."""
    found = []
    for rate in ("0", "1e9"):
        sim = simkit.load(world(car(plugin().replace("<update_rate>0<", f"<update_rate>{rate}<"))))
        drive(sim, 0.5, 0.3, 0.2)
        found.append(sim.mj_data.qpos.tobytes())
    assert found[0] == found[1]


def test_the_first_axis_of_universal_joints_is_used_with_a_warning():
    second = "<axis2><xyz>0 0 1</xyz><limit><lower>0</lower><upper>0</upper></limit></axis2>"
    text = car(plugin()).replace('type="continuous"', 'type="universal"')
    text = text.replace("<xyz>0 1 0</xyz></axis></joint>", f"<xyz>0 1 0</xyz></axis>{second}</joint>")
    sim = simkit.load(world(text))
    assert len([d for d in sim.diagnostics if (d.code, d.severity) == ("SK-PLUGIN-003", "warning")]) == 4
    drive(sim, 0.5, 0.0, 4.0)
    assert sim.joint("car::rr_joint").velocity[0] * 0.1 == pytest.approx(0.5, abs=0.02)
    assert sim.link("car::base").linear_velocity[0] == pytest.approx(0.5, abs=0.03)
