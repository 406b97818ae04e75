"""Floating robots of freefloating_gazebo and usv_sim_lsa: buoyancy, drag, current, wind, thrusters and foils."""

from __future__ import annotations

import math

import pytest

import simkit

MASS, LIFT, DRAG = 20.0, 1.1, 40.0
FLUID = """<plugin name="water" filename="libfreefloating_gazebo_fluid.so"><surface>0 0 0</surface>
  <fluidTopic>current</fluidTopic></plugin>"""
BUOYANCY = f"""<buoyancy><compensation>{LIFT}</compensation><origin xyz="0 0 0.1"/><limit radius="0.2"/>
  <damping xyz="{DRAG} {DRAG} {DRAG}" rpy="20 20 20"/></buoyancy>"""
THRUSTERS = """<thruster><map>1 0 0 0 0 -0.5</map><effort>30</effort></thruster>
  <thruster><map>1 0 0 0 0 0.5</map><effort>30</effort><name>left</name></thruster>
  <thruster><name>screw</name><effort>10</effort></thruster>"""


def world(plugins: str = FLUID, wind: str = "0 0 0") -> str:
    return f"""<sdf version="1.6"><world name="w"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
      <wind><linear_velocity>{wind}</linear_velocity></wind>{plugins}</world></sdf>"""


def robot(water: str = BUOYANCY, thrusters: str = THRUSTERS, more: str = "") -> str:
    return f"""<robot name="auv"><link name="base_link"><inertial><mass value="{MASS}"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>{water}</link>
      <link name="screw"/><joint name="mount" type="fixed"><origin xyz="0 0 0" rpy="3.14159265 0 0"/>
        <parent link="base_link"/><child link="screw"/></joint>
      <link name="arm"><inertial><mass value="0.1"/>
        <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="elbow" type="continuous"><parent link="base_link"/><child link="arm"/><axis xyz="0 0 1"/></joint>
      <gazebo><plugin name="freefloating_gazebo_control" filename="libfreefloating_gazebo_control.so">
        <switchService>switch</switchService><updateRate>100</updateRate><link>base_link</link>{thrusters}</plugin>
      </gazebo>{more}</robot>"""


def dive(urdf: str, depth: float = 2.0, world_text: str = "") -> simkit.Simulation:
    sim = simkit.load(world_text or world())
    sim.spawn(urdf, "auv", simkit.Pose((0.0, 0.0, -depth)))
    assert not [d for d in sim.diagnostics if d.severity != "note" and "LINT" not in d.code]
    return sim


def push(sim: simkit.Simulation, **thrusts: float) -> None:
    sim.publish("/auv/thruster_command", {"name": list(thrusts), "effort": list(thrusts.values())})


@pytest.mark.slow
def test_a_light_robot_rises_to_the_height_where_its_lift_carries_it() -> None:
    with dive(robot()) as sim:
        base = sim.link("auv::base_link")
        sim.run(2.0)
        weight, lift = (MASS + 0.1) * 9.8, MASS * LIFT * 9.81
        assert base.linear_velocity[2] == pytest.approx(math.sqrt((lift - weight) / DRAG), rel=0.02)
        sim.run(60.0)
        height = 0.2 * (math.acos(weight / lift) * 4 / math.pi - 1)
        assert base.pose.position[2] + 0.1 == pytest.approx(height, abs=0.01)  # the oscillation decays slowly


@pytest.mark.slow
def test_thrusters_drive_and_turn_the_robot_within_their_limits() -> None:
    with dive(robot(BUOYANCY.replace(str(LIFT), "1.004")), 20.0) as sim:
        base, use = sim.link("auv::base_link"), sim.subscribe("/auv/thruster_use", keep=1)
        push(sim, thr0=15.0, left=15.0)
        sim.run(20.0)
        assert base.linear_velocity[0] == pytest.approx(math.sqrt(30 / DRAG), rel=0.02)
        assert list(use.messages[-1].position) == [50.0, 50.0, 0.0]
        push(sim, thr0=-10.0, left=50.0)
        sim.run(0.5)
        assert list(use.messages[-1].position) == pytest.approx([100 / 3, 100, 0])
        assert base.angular_velocity[2] > 0.5
        push(sim, thr0=0.0, left=0.0, screw=10.0)  # this thruster's link is upside down, so it lifts
        sim.run(2.0)
        assert base.linear_velocity[2] > 0.3


def test_a_thruster_above_the_water_has_no_thrust() -> None:
    with dive(robot(), depth=-3.0) as sim:
        push(sim, thr0=30.0, left=30.0)
        sim.run(0.4)
        assert sim.link("auv::base_link").linear_velocity[0] == 0.0


def test_a_wrench_is_shared_among_thrusters_with_maps() -> None:
    fixed = THRUSTERS.replace("<thruster><name>screw</name><effort>10</effort></thruster>", "")
    with dive(robot(thrusters=fixed)) as sim:
        use = sim.subscribe("/auv/thruster_use", keep=1)
        sim.publish("/auv/body_command", {"force": {"x": 12.0}, "torque": {"z": 3.0}})
        sim.run(0.1)
        assert list(use.messages[-1].position) == pytest.approx([10.0, 30.0])  # 3 N and 9 N of 30 N


@pytest.mark.slow
def test_the_current_carries_the_robot_and_the_state_shows_it() -> None:
    with dive(robot(BUOYANCY.replace(str(LIFT), "1.005"))) as sim:
        state = sim.subscribe("/auv/state", keep=1)
        sim.publish("/gazebo/current", {"x": 0.0, "y": 0.4, "z": 0.0})
        sim.run(40.0)
        velocity = sim.link("auv::base_link").linear_velocity
        assert velocity[1] == pytest.approx(0.4, rel=0.1)
        assert math.hypot(state.messages[-1].twist.twist.linear.x, state.messages[-1].twist.twist.linear.y) == (
            pytest.approx(math.hypot(*velocity[:2]), abs=0.01)
        )


def test_joints_follow_commanded_efforts() -> None:
    with dive(robot()) as sim:
        states = sim.subscribe("/auv/joint_states", keep=1)
        sim.publish("/auv/joint_command", {"name": ["elbow"], "effort": [0.01]})
        sim.run(0.5)
        assert sim.joint("auv::elbow").velocity == pytest.approx(0.5, rel=0.05)  # 0.01 N·m, 0.01 kg·m²
        assert list(states.messages[-1].name) == ["elbow"]


def test_added_mass_slows_the_acceleration() -> None:
    added = " ".join("20" if i % 7 == 0 else "0" for i in range(36))
    fluid = f"""<fluid><density>1</density><origin xyz="0 0 0"/><buoyancy><compensation>1.0</compensation>
      <limit radius="0.2"/></buoyancy><hydrodynamics><drag xyz="5 5 5" rpy="1 1 1" type="linear"/>
      <added_mass>{added}</added_mass></hydrodynamics></fluid>"""
    with dive(robot(fluid)) as sim:
        push(sim, thr0=20.0, left=20.0)
        sim.run(0.5)
        total = MASS + 0.1 + 20
        expected = 40 / 5 * (1 - math.exp(-5 / total * 0.5))
        assert sim.link("auv::base_link").linear_velocity[0] == pytest.approx(expected, rel=0.03)


@pytest.mark.slow
def test_a_boat_of_usv_sim_lsa_is_pushed_by_the_wind_and_floats_on_a_moved_surface() -> None:
    boat = BUOYANCY.replace("</buoyancy>", "<windVelocity>global</windVelocity><waterVelocity>none</waterVelocity>")
    limits = "<effortUnderWater>11</effortUnderWater><effortOverWater>2</effortOverWater>"
    thruster = f"<thruster>{limits}<name>screw</name></thruster>"
    with dive(robot(boat + "</buoyancy>", thruster), 0.1, world(wind="10 0 0")) as sim:
        base = sim.link("auv::base_link")
        sim.run(20.0)
        assert base.linear_velocity[0] > 0.05
        sim.publish("/auv/Surface/base_link", {"x": 0.0, "y": 0.0, "z": 1.0})
        before = base.pose.position[2]
        sim.run(20.0)
        assert base.pose.position[2] == pytest.approx(before + 1.0, abs=0.05)


@pytest.mark.slow
def test_a_removed_and_a_second_robot_leave_the_others_afloat() -> None:
    with dive(robot()) as sim:
        sim.spawn(robot(), "second", simkit.Pose((5.0, 0.0, -1.0)))
        sim.run(1.0)
        sim.remove("auv")
        sim.run(20.0)
        assert -0.5 < sim.link("second::base_link").pose.position[2] < 0.2


def test_a_restored_dive_goes_on_with_the_same_bits() -> None:
    with dive(robot()) as sim:
        push(sim, thr0=5.0)
        sim.run(0.5)
        saved = sim.snapshot()
        sim.run(0.5)
        expected = sim.link("auv::base_link").pose.position.tolist()
        sim.restore(saved)
        sim.run(0.5)
        assert sim.link("auv::base_link").pose.position.tolist() == expected


def test_wrong_numbers_are_reported_at_their_line() -> None:
    report = simkit.check(robot(thrusters="<thruster><map>1 0 0</map></thruster>"))
    assert any(d.code == "SK-PARAM-002" and "expected 6 finite numbers" in d.message for d in report)
    assert any(d.code == "SK-URDF-033" for d in report)


def foil(kind: str, forward: str, velocity: str, more: str = "") -> str:
    return f"""<sdf version="1.6"><world name="w"><gravity>0 0 0</gravity>
      <physics type="ode"><max_step_size>0.002</max_step_size></physics>
      <wind><linear_velocity>{velocity}</linear_velocity></wind><model name="boat"><link name="blade"><inertial>
      <mass>1000</mass><inertia><ixx>500</ixx><iyy>500</iyy><izz>500</izz></inertia></inertial></link>
      <plugin name="f" filename="libfoil_dynamics_plugin.so"><link_type>{kind}</link_type><link_name>blade</link_name>
      <area>0.5</area><forward>{forward}</forward><upward>0 1 0</upward><fluidVelocity>global</fluidVelocity>{more}
      </plugin></model></world></sdf>"""


def test_a_keel_and_a_rudder_have_lift_and_drag_of_the_angle_of_attack() -> None:
    angle = 0.2  # of the stream, which comes from the bow and from the right
    for kind, more, lift, drag in (("keel", "", 8, 4), ("rudder", "<mult_lift>1.2</mult_lift>", 1.2, 1.0)):
        with simkit.load(foil(kind, "1 0 0", "0 0 0", more)) as sim:
            blade = sim.link("boat::blade")
            blade.set_velocity((math.cos(angle), -math.sin(angle), 0.0))
            sim.run(0.004)
            gained = (blade.linear_velocity - (math.cos(angle), -math.sin(angle), 0.0)) / 0.004 * 1000
            pressed = 0.5 * 1000.1 * 0.5
            up, back = lift * math.sin(2 * angle) * pressed, drag * (1 - math.cos(2 * angle)) * pressed
            assert gained[0] == pytest.approx(up * math.sin(angle) - back * math.cos(angle), rel=0.05, abs=1.0)
            assert gained[1] == pytest.approx(up * math.cos(angle) + back * math.sin(angle), rel=0.05)


@pytest.mark.slow
def test_a_sail_across_the_boat_is_pushed_by_the_wind_and_a_keel_follows_the_current() -> None:
    with simkit.load(foil("sail", "-1 0 0", "0 6 0", "<fluid_density>1.2</fluid_density>")) as sim:
        sim.run(0.1)
        expected = 4 * 2 * 0.5 * 1.2 * 36 * 0.5 * 0.1 / 1000  # the stream is at a right angle: drag alone
        assert sim.link("boat::blade").linear_velocity == pytest.approx([0, expected, 0], rel=0.01, abs=1e-6)
    with simkit.load(foil("keel", "1 0 0", "0 6 0")) as sim:
        sim.publish("/gazebo/current", {"x": 0.0, "y": 0.3, "z": 0.0})
        sim.run(60.0)
        assert sim.link("boat::blade").linear_velocity[1] == pytest.approx(0.3, abs=0.02)
