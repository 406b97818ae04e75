"""The sensors of the Kobuki base in Gazebo Classic: bumper, cliff and wheel drop events, IMU and heading."""

from __future__ import annotations

import math
from typing import Any

import pytest
from plugin_worlds import element

import simkit
from simkit_robots.plugins.classic.kobuki_sensors import bumper_zone, converter_value

TOPIC = "/mobile_base/commands/velocity"
EVENTS = "/mobile_base/events"
SETTINGS = {
    "left_wheel_joint_name": "wheel_left_joint", "right_wheel_joint_name": "wheel_right_joint", "imu_name": "imu",
    "wheel_separation": 0.23, "wheel_diameter": 0.07, "bumper_name": "bumpers", "cliff_sensor_left_name": "cliff_left",
    "cliff_sensor_center_name": "cliff_center", "cliff_sensor_right_name": "cliff_right",
}  # fmt: skip
WHEEL = """<link name='{s}'><pose>0 {y} 0.035 -1.5707963267948966 0 0</pose><inertial><mass>0.1</mass>
<inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial>
<collision name='c'><geometry><sphere><radius>0.035</radius></sphere></geometry></collision></link>
<joint name='wheel_{s}_joint' type='continuous'><parent>base</parent><child>{s}</child><axis><xyz>0 0 1</xyz></axis>
</joint>"""
CLIFF = """<sensor name='cliff_{0}' type='ray'><pose>{1} {2} -0.02 0 1.5707963267948966 0</pose>
<update_rate>50</update_rate><ray><scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle>
</horizontal></scan><range><min>0.01</min><max>0.15</max></range></ray></sensor>"""
SENSORS = (
    "<sensor name='bumpers' type='contact'><update_rate>50</update_rate><contact><collision>base</collision></contact>"
    "</sensor><sensor name='imu' type='imu'><update_rate>50</update_rate></sensor>"
) + "".join(CLIFF.format(*p) for p in (("left", 0.08, 0.13), ("center", 0.15, 0), ("right", 0.08, -0.13)))

CASTERS = "".join(
    f"<collision name='caster_{x}'><pose>{x} 0 -0.04 0 0 0</pose><geometry><sphere><radius>0.01</radius></sphere>"
    "</geometry><surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>"
    for x in (0.12, -0.12)
)


def load(pose: str = "0 0 0 0 0 0", scenery: str = "", inner: str = "", **values: object) -> simkit.Simulation:
    """Load a base on a floor that ends at x = 1 m; below the end is nothing."""
    base = f"""<link name='base'><pose>0 0 0.05 0 0 0</pose><inertial><pose>-0.01 0 -0.04 0 0 0</pose><mass>2.4</mass>
    <inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.04</izz></inertia></inertial><collision name='base'>
    <geometry><cylinder><radius>0.17</radius><length>0.06</length></cylinder></geometry></collision>{CASTERS}{SENSORS}</link>"""
    wheels = "".join(WHEEL.format(s=s, y=y) for s, y in (("left", 0.115), ("right", -0.115)))
    plugin = element("plugin", {**SETTINGS, **values}, "name='kobuki' filename='libgazebo_ros_kobuki.so'")
    floor = """<model name='floor'><static>true</static><pose>-2 0 -0.5 0 0 0</pose><link name='l'><collision name='c'>
    <geometry><box><size>6 6 1</size></box></geometry></collision></link></model>"""
    robot = f"<model name='kobuki'><pose>{pose}</pose>{base}{wheels}{inner}{plugin}</model>"
    step = "<physics type='ode'><max_step_size>0.002</max_step_size></physics>"
    return simkit.load(f"<sdf version='1.9'><world name='w'>{step}{floor}{scenery}{robot}</world></sdf>")


def wall(x: float, y: float, yaw: float) -> str:
    return f"""<model name='wall'><static>true</static><pose>{x} {y} 0.2 0 0 {yaw}</pose><link name='l'>
    <collision name='c'><geometry><box><size>0.1 4 0.4</size></box></geometry></collision></link></model>"""


def drive(sim: simkit.Simulation, speed: float, seconds: float, turn: float = 0.0) -> None:
    """Drive with a command every 0.5 s, before the timeout of 0.6 s."""
    for _ in range(round(seconds / 0.5)):
        sim.publish(TOPIC, {"linear": {"x": speed}, "angular": {"z": turn}})
        sim.run(0.5)


@pytest.mark.parametrize(
    ("angle", "zone"),
    [(0, 1), (29, 1), (31, 0), (-31, 2), (89, 0), (-89, 2), (91, None), (-91, None), (180, None), (355, 1)],
)
def test_a_zone_of_the_bumper_covers_60_degrees(angle: float, zone: int | None) -> None:
    assert bumper_zone(math.radians(angle)) == zone


def test_the_value_of_the_converter_has_16_bits() -> None:
    assert converter_value(0.04) == int(76123 * math.atan(0.995 / 0.04)) - 65536
    assert converter_value(1e9) == 0


@pytest.mark.parametrize(("yaw", "zone"), [(0.0, 1), (-0.9, 0), (0.9, 2)])
@pytest.mark.parametrize("heading", [0.0, 3.1])
def test_a_wall_presses_the_zone_that_touches_it(yaw: float, zone: int, heading: float) -> None:
    """`yaw` is the direction of the robot relative to the wall's normal; the heading of 3.1 rad needs the wrap."""
    x, y = -2 + 0.4 * math.cos(heading), 0.4 * math.sin(heading)
    with load(f"-2 0 0 0 0 {heading + yaw}", wall(x, y, heading)) as sim:
        events = sim.subscribe(f"{EVENTS}/bumper")
        drive(sim, 0.2, 2.0)
        assert [(m.bumper, m.state) for m in events.messages][:1] == [(zone, 1)]
        assert {m.bumper for m in events.messages} == {zone}
        drive(sim, -0.2, 1.0)
        assert [(m.bumper, m.state) for m in events.messages][-1:] == [(zone, 0)]


def test_the_cliff_sensors_report_the_edge_and_the_floor_again() -> None:
    with load("0.6 0 0 0 0 0") as sim:
        events = sim.subscribe(f"{EVENTS}/cliff")
        seen: dict[int, float] = {}
        for _ in range(14):
            drive(sim, 0.04, 0.5)
            for event in events.messages:
                seen.setdefault(event.sensor, sim.model("kobuki").pose.position[0])
        assert [(m.sensor, m.state) for m in events.messages] == [(1, 1)]
        assert events.messages[0].bottom == converter_value(0.15)
        assert seen[1] == pytest.approx(1 - 0.15, abs=0.04 * 0.5 + 0.001)
        drive(sim, -0.1, 1.0)
        assert [(m.sensor, m.state) for m in events.messages] == [(1, 1), (1, 0)]
        assert events.messages[1].bottom == pytest.approx(converter_value(0.03), abs=200)


def test_a_late_subscriber_gets_only_later_changes() -> None:
    with load("0.87 0 0 0 0 0") as sim:
        sim.run(0.2)
        events = sim.subscribe(f"{EVENTS}/cliff")
        sim.run(0.2)
        assert not events.messages


def test_the_side_sensors_of_the_cliff_are_left_and_right() -> None:
    with load("0.9 0 0 0 0 1.5707963") as sim:
        events = sim.subscribe(f"{EVENTS}/cliff")
        sim.run(0.2)
        assert [(m.sensor, m.state) for m in events.messages] == [(2, 1)]


def test_a_lifted_base_drops_its_wheels() -> None:
    with load() as sim:
        events = sim.subscribe(f"{EVENTS}/wheel_drop")
        sim.run(0.5)
        assert not events.messages
        robot = sim.model("kobuki")
        robot.set_pose(simkit.Pose((0, 0, 0.3)))
        sim.run(0.15)  # a fall of 0.3 m lasts 0.25 s
        assert [(m.wheel, m.state) for m in events.messages] == [(0, 1), (1, 1)]
        sim.run(0.5)
        assert [(m.wheel, m.state) for m in events.messages] == [(0, 1), (1, 1), (0, 0), (1, 0)]


def test_the_imu_is_published_at_its_rate_with_the_covariances_of_the_source() -> None:
    with load() as sim:
        imu = sim.subscribe("/mobile_base/sensors/imu_data")
        drive(sim, 0.0, 1.0, turn=0.5)
        last = imu.messages[-1]
        assert len(imu.messages) == 50
        assert last.angular_velocity.z == pytest.approx(0.5, rel=0.02)
        assert last.linear_acceleration.z == pytest.approx(9.8, abs=0.05)
        assert last.header.frame_id == "base_link"
        assert (last.angular_velocity_covariance[0], last.angular_velocity_covariance[8]) == (1e6, 0.05)


def test_the_heading_of_the_odometry_is_from_the_imu() -> None:
    turned: dict[str, Any] = {}
    for name in ("imu", ""):
        with load(torque=10, imu_name=name) as sim:
            odometry = sim.subscribe("/odom", keep=1)
            sim.joint("kobuki::wheel_right_joint").set_position(2.0)  # a wheel turns without the base
            drive(sim, 0.1, 1.0, turn=0.5)
            orientation = odometry.messages[-1].pose.pose.orientation
            turned[name] = 2 * math.atan2(orientation.z, orientation.w)
            turned["true"] = sim.model("kobuki").pose.rpy[2]
    assert turned["imu"] == pytest.approx(turned["true"], abs=0.01)
    assert turned[""] - turned["true"] == pytest.approx(2.0 * 0.035 / 0.23, abs=0.03)


def test_the_events_can_have_the_types_of_ros_1() -> None:
    with load(message_package="kobuki_msgs") as sim:
        topics = sim.topics()
    assert topics[f"{EVENTS}/bumper"] == "kobuki_msgs/msg/BumperEvent"
    with load() as sim:
        assert sim.topics()[f"{EVENTS}/cliff"] == "kobuki_ros_interfaces/msg/CliffEvent"


def test_the_middle_cliff_sensor_may_have_the_name_of_old_files() -> None:
    with load("0.9 0 0 0 0 0", cliff_sensor_center_name="", cliff_sensor_front_name="cliff_center") as sim:
        events = sim.subscribe(f"{EVENTS}/cliff")
        sim.run(0.2)
        assert [(m.sensor, m.state) for m in events.messages] == [(1, 1)]


def test_a_snapshot_keeps_the_states_of_the_sensors() -> None:
    with load("-2 0 0 0 0 0", wall(-1.6, 0, 0)) as sim:
        events = sim.subscribe(f"{EVENTS}/bumper")
        drive(sim, 0.2, 2.0)
        pressed = len(events.messages)
        snapshot = sim.snapshot()
        drive(sim, -0.2, 1.0)
        first = [(m.bumper, m.state) for m in events.messages][pressed:]
        sim.restore(snapshot)
        before = len(events.messages)
        drive(sim, -0.2, 1.0)
        assert [(m.bumper, m.state) for m in events.messages][before:] == first == [(1, 0)]


def test_the_cliff_sensors_look_through_the_base_around_them() -> None:
    """In the published description, the sensors are links of their own inside the cylinder of the base."""
    inner = "".join(
        f"<link name='{side}'><pose>{x} {y} 0.03 0 1.5707963267948966 0</pose><inertial><mass>1e-4</mass></inertial>"
        f"{CLIFF.format(side, 0, 0).replace('0 0 -0.02 0 1.5707963267948966 0', '0 0 0 0 0 0')}</link>"
        f"<joint name='{side}_joint' type='fixed'><parent>base</parent><child>{side}</child></joint>"
        for side, x, y in (("inner_left", 0.08, 0.13), ("inner_center", 0.15, 0.0))
    )
    names = {"cliff_sensor_left_name": "cliff_inner_left", "cliff_sensor_center_name": "cliff_inner_center"}
    with load("0.9 0 0 0 0 0", inner=inner, **names) as sim:
        events = sim.subscribe(f"{EVENTS}/cliff")
        sim.run(0.2)
        assert [(m.sensor, m.state) for m in events.messages] == [(1, 1)]
        left = sim.sensor("kobuki::inner_left::cliff_inner_left").latest
        assert left.ranges[0] == pytest.approx(0.03, abs=0.001)


def test_the_state_contains_all_sensors_as_bits_and_ticks() -> None:
    with load("-2 0 0 0 0 0", wall(-1.6, 0, 0)) as sim:
        states = sim.subscribe("/mobile_base/sensors/core")
        drive(sim, 0.2, 1.0)
        wheels = [sim.joint(f"kobuki::wheel_{side}_joint").position for side in ("left", "right")]
        state = states.messages[-1]
        assert len(states.messages) == 50
        assert (state.bumper, state.cliff, state.wheel_drop, state.time_stamp) == (2, 0, 0, 1000)
        ticks = [state.left_encoder, state.right_encoder]
        assert ticks == pytest.approx([angle / 0.002436916871363930 for angle in wheels], abs=1)
        sim.model("kobuki").set_pose(simkit.Pose((-2, 0, 0.5)))
        sim.run(0.1)
        state = states.messages[-1]
        assert (state.bumper, state.cliff, state.wheel_drop) == (0, 7, 3)
        assert list(state.bottom) == [converter_value(0.15)] * 3


def test_a_wheel_that_turns_backwards_counts_down_from_65536() -> None:
    with load("-2 0 0 0 0 0") as sim:
        states = sim.subscribe("/mobile_base/sensors/core", keep=1)
        drive(sim, -0.1, 0.5)
        assert 65536 - 0.06 / 0.035 / 0.0024369 < states.messages[-1].left_encoder < 65536
