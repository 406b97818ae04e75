"""Wheel slip: Gazebo's WheelSlip, its service, and the plugins of Gazebo Classic."""

from __future__ import annotations

import math

import pytest
from car_worlds import car, world

import simkit
from simkit.errors import ParameterError

DRIVE = """<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>rl_joint</left_joint><right_joint>rr_joint</right_joint><wheel_separation>0.4</wheel_separation>
  <wheel_radius>0.1</wheel_radius></plugin>
<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
  <joint_name>fl_steering</joint_name><p_gain>50</p_gain><d_gain>2</d_gain></plugin>
<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
  <joint_name>fr_steering</joint_name><p_gain>50</p_gain><d_gain>2</d_gain></plugin>"""
MASS, RADIUS, FORCE = 9 + 4 * 0.5 + 2 * 0.5, 0.1, 30.0


def wheels(lateral, longitudinal, names=("fl", "fr", "rl", "rr")):
    return "".join(
        f"""<wheel link_name="{name}"><slip_compliance_lateral>{lateral}</slip_compliance_lateral>
        <slip_compliance_longitudinal>{longitudinal}</slip_compliance_longitudinal>
        <wheel_normal_force>{FORCE}</wheel_normal_force><wheel_radius>{RADIUS}</wheel_radius></wheel>"""
        for name in names
    )


def slip(content, filename="gz-sim-wheel-slip-system", name="gz::sim::systems::WheelSlip"):
    return f'<plugin filename="{filename}" name="{name}">{content}</plugin>'


def driven(plugin, pull=(0.0, 0.0), speed=0.5, duration=2.0, step=0.002):
    """Return a car that drives forwards while a force per mass [m/s²] pulls it backwards or sideways."""
    gravity = f"{pull[0]} {pull[1]} -9.8"
    sim = simkit.load(world(car(DRIVE + plugin), gravity=gravity, step=step))
    sim.publish("/model/car/cmd_vel", {"linear": {"x": speed}})
    sim.run(duration)
    return sim


def velocity(sim):
    """Return the velocity forwards and to the left, in the car's axes."""
    base = sim.link("car::base")
    return base.pose.inverse().matrix @ base.linear_velocity


def test_driven_wheels_slip_in_proportion_to_the_force_on_them():
    """Each of two wheels pushes with half of the force: v = rω (1 - s F / 2N)."""
    sim = driven(slip(wheels(0, 1, ("rl", "rr"))), pull=(-1.0, 0.0))
    rim = sim.joint("car::rl_joint").velocity * RADIUS
    lost = rim * 1.0 * (MASS * 1.0 / 2) / FORCE
    assert rim - velocity(sim)[0] == pytest.approx(lost, rel=0.03)


def test_without_compliance_wheels_do_not_slip():
    sim = driven(slip(wheels(0, 0)), pull=(-1.0, 0.0))
    rim = sim.joint("car::rl_joint").velocity * RADIUS
    assert velocity(sim)[0] == pytest.approx(rim, abs=2e-3)


def test_all_wheels_slip_sideways_together():
    """Each wheel carries a part of the sideways force, and the car drifts at rω s F / 4N."""
    sim = driven(slip(wheels(0.5, 0.5)), pull=(0.0, 0.5), duration=2.0)
    ahead, left = velocity(sim)[:2]
    turned = sim.model("car").pose.rpy[2]
    assert abs(turned) < 0.15
    rim = sim.joint("car::rl_joint").velocity * RADIUS
    assert left == pytest.approx(rim * 0.5 * MASS * 0.5 * math.cos(turned) / 4 / FORCE, rel=0.15)
    assert ahead == pytest.approx(rim, rel=0.02)


def test_at_rest_nothing_slips():
    sim = driven(slip(wheels(1, 1)), pull=(-1.0, 1.0), speed=0.0)
    assert velocity(sim)[1] == pytest.approx(0.0, abs=2e-3)


def test_a_service_sets_the_compliances_of_a_link_or_a_model():
    sim = driven(slip(wheels(0, 0)), pull=(-1.0, 0.0), duration=1.0)
    answer = sim.call("/world/w/wheel_slip", _request("car::rl", 3, 0.25, 0.75))
    assert answer.success
    (own,) = [
        found for found in sim.communication.parameters.values() if "slip_compliance_unitless_lateral/rl" in found
    ]
    assert own["slip_compliance_unitless_lateral/rl"].value == 0.25
    assert own["slip_compliance_unitless_longitudinal/rl"].value == 0.75
    assert own["slip_compliance_unitless_longitudinal/rr"].value == 0.0
    assert sim.call("/world/w/wheel_slip/blocking", _request("car", 2, 0.0, 1.0)).success
    sim.run(2.0)
    rim = sim.joint("car::rl_joint").velocity * RADIUS
    assert rim - velocity(sim)[0] == pytest.approx(rim * MASS / 2 / FORCE, rel=0.05)
    refused = sim.call("/world/w/wheel_slip", _request("car::base", 3, 1.0, 1.0))
    assert not refused.success and "no wheel of a wheel slip plugin" in refused.status_message


def _request(name, kind, lateral, longitudinal):
    entity = {"name": name, "type": kind}
    return {"entity": entity, "slip_compliance_lateral": lateral, "slip_compliance_longitudinal": longitudinal}


def test_a_restore_and_a_reset_include_the_compliances():
    sim = driven(slip(wheels(0, 0)), duration=0.2)
    node = next(
        name for name, own in sim.communication.parameters.items() if "slip_compliance_unitless_lateral/rl" in own
    )
    kept = sim.snapshot()
    sim.run(0.2)
    there = sim.mj_data.qpos.tobytes()
    sim.restore(kept)
    sim.set_parameter(node, "slip_compliance_unitless_longitudinal/rl", 2.0)
    sim.run(0.2)
    sim.restore(kept)
    sim.run(0.2)
    assert sim.mj_data.qpos.tobytes() == there
    with pytest.raises(ParameterError):
        sim.set_parameter(node, "slip_compliance_unitless_lateral/rl", -1.0)


def test_the_classic_plugin_publishes_the_slip():
    sim = simkit.load(
        world(
            car(DRIVE + slip(wheels(0, 1, ("rl", "rr")), "libgazebo_ros_wheel_slip.so", "slip")),
            gravity="-1 0 -9.8",
        )
    )
    slips = sim.subscribe("/wheel_slip")
    sim.publish("/model/car/cmd_vel", {"linear": {"x": 0.5}})
    sim.run(2.0)
    message = slips.messages[-1]
    assert list(message.name) == ["rl", "rr"]
    assert list(message.longitudinal_slip) == pytest.approx([MASS / 2 / FORCE] * 2, rel=0.03)
    assert list(message.lateral_slip) == pytest.approx([0.0, 0.0], abs=0.02)
    sim.set_parameter("/slip", "slip_compliance_unitless_longitudinal", 0.5)
    sim.run(1.0)
    assert list(slips.messages[-1].longitudinal_slip) == pytest.approx([MASS / 4 / FORCE] * 2, rel=0.06)


def test_a_compliance_that_is_changed_during_the_run_follows_the_formula():
    """The pull is a force, because tilted gravity would also tilt Classic's forward direction and its slip."""
    content = slip(wheels(0, 1, ("rl", "rr")), "libgazebo_ros_wheel_slip.so", "slip")
    sim = simkit.load(world(car(DRIVE + content)))
    slips = sim.subscribe("/wheel_slip")
    sim.publish("/model/car/cmd_vel", {"linear": {"x": 0.5}})
    for compliance in (1.0, 0.5, 2.0):
        sim.set_parameter("/slip", "slip_compliance_unitless_longitudinal", compliance)
        for _ in range(1000):
            sim.link("car::base").apply_wrench((-MASS, 0.0, 0.0))
            sim.step()
        expected = [compliance * MASS / 2 / FORCE] * 2
        assert list(slips.messages[-1].longitudinal_slip) == pytest.approx(expected, rel=5e-3)


def test_a_reading_of_an_earlier_tick_uses_the_slips_of_that_tick():
    """A late reading shows the state of its tick, independent of later changes."""

    def accelerations(sets):
        sim = driven(slip(wheels(0, 1)), pull=(-1.0, 0.0), duration=0.3)
        held = sim.engine.physics.hold()
        sim.step()
        if sets:
            assert sim.call("/world/w/wheel_slip", _request("car", 2, 0.0, 0.0)).success
        return sim.engine.physics.data_of(held).qacc.tobytes()

    assert accelerations(False) == accelerations(True)


def test_classics_own_plugin_takes_the_radius_of_the_wheel_and_numbers_by_topic():
    content = wheels(0, 1, ("rl", "rr")).replace(f"<wheel_radius>{RADIUS}</wheel_radius>", "")
    sim = simkit.load(world(car(DRIVE + slip(content, "libWheelSlipPlugin.so", "slip")), gravity="-1 0 -9.8"))
    slips = sim.subscribe("/car/wheel_slip/rl")
    sim.publish("/model/car/cmd_vel", {"linear": {"x": 0.5}})
    sim.run(2.0)
    message = slips.messages[-1]
    assert message.z == pytest.approx(0.5, abs=0.03)
    assert message.x == pytest.approx(-message.z * MASS / 2 / FORCE, rel=0.03)
    sim.publish("/car/wheel_slip/longitudinal_compliance", {"data": 0.0})
    sim.run(1.0)
    assert slips.messages[-1].x == pytest.approx(0.0, abs=3e-3)


def test_all_errors_are_reported_together():
    content = (
        wheels(-1, 0, ("rl",))
        + wheels(0, 0, ("nowhere",))
        + wheels(0, 0, ("base",))
        + "<wheel><wheel_normal_force>0</wheel_normal_force></wheel>"
    )
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world(car(slip(content))))
    text = str(caught.value)
    for part in ("slip_compliance_lateral", "'nowhere'", "SK-PLUGIN-091", "wheel_normal_force", "link_name"):
        assert part in text
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-092"):
        simkit.load(world(car(slip(wheels(0, 0, ("rl", "rl"))))))
    with pytest.raises(simkit.LoadError, match="<wheel>"):
        simkit.load(world(car(slip(""))))
