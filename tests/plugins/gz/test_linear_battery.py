"""Battery of Gazebo against its formula and the conservation of charge, and the battery of Gazebo Classic."""

from __future__ import annotations

import math
from typing import Any

import pytest

import simkit
from simkit.errors import LoadError

INERTIAL = "<inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
JOINT = """<joint name="w" type="fixed"><parent>world</parent><child>b</child></joint>
<joint name="j" type="continuous"><parent>b</parent><child>a</child><axis><xyz>0 0 1</xyz></axis></joint>"""
GZ = 'filename="gz-sim-linearbatteryplugin-system" name="gz::sim::systems::LinearBatteryPlugin"'
VELOCITY = 'filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController"'
STATE = "/model/r/battery/main/state"
REAL = {  # of gz's example world: a 12 V battery of 1.2 Ah
    "voltage": 12.592,
    "open_circuit_voltage_constant_coef": 12.694,
    "open_circuit_voltage_linear_coef": -3.1424,
    "initial_charge": 1.1665,
    "capacity": 1.2009,
    "resistance": 0.061523,
    "smooth_current_tau": 1.9499,
    "fix_issue_225": "true",
    "power_load": 100,
    "start_draining": "true",
}
PLAIN = {"voltage": 10, "open_circuit_voltage_constant_coef": 10, "capacity": 0.01, "smooth_current_tau": 1e-9}


def world(more: str = "", quirks: bool = False, other: str = "", **values: Any) -> str:
    elements = "".join(f"<{name}>{value}</{name}>" for name, value in values.items())
    plugin = f"<plugin {GZ}><battery_name>main</battery_name>{elements}{more}</plugin>"
    drive = f"<plugin {VELOCITY}><joint_name>j</joint_name></plugin>"
    err = "<simkit:gazebo_quirks>true</simkit:gazebo_quirks>" if quirks else ""
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit"><world name="w">{err}<gravity>0 0 0</gravity>
    <model name="r"><link name="b">{INERTIAL}</link><link name="a">{INERTIAL}</link>{JOINT}{drive}{plugin}{other}
    </model></world></sdf>"""


def state(sim: Any, duration: float, topic: str = STATE) -> Any:
    subscription = sim.subscribe(topic, keep=1)
    sim.run(duration)
    subscription.close()
    return subscription.latest


def test_the_example_of_gazebo_drains_by_its_formula() -> None:
    with simkit.load(world(**REAL)) as sim:
        found = state(sim, 2.0)
    e0, e1, c, r = 12.694, -3.1424, 1.2009, 0.061523
    q, current, volts = 1.1665, 0.0, 12.592
    for _ in range(2000):
        current += 0.001 / 1.9499 * (100 / volts - current)
        q -= 0.001 * current / 3600
        volts = e0 + e1 * (1 - q / c) - r * current
    assert (found.voltage, found.current, found.charge) == pytest.approx((volts, current, q), rel=1e-6)
    assert found.percentage == pytest.approx(100 * q / c, rel=1e-6)
    assert (found.power_supply_status, found.present, found.capacity) == (2, True, pytest.approx(c))
    assert math.isnan(found.temperature)


def test_the_lost_charge_is_the_integral_of_the_current() -> None:
    """A load of 90 W at 10 V without losses draws 9 A: 0.0025 A·h in a second."""
    with simkit.load(world(**PLAIN, power_load=90, start_draining=1)) as sim:
        found = state(sim, 1.0)
        assert found.charge == pytest.approx(0.01 - 9 / 3600, rel=1e-5)
        assert found.percentage == pytest.approx(0.75, rel=1e-5), "a fraction without <fix_issue_225>"
        assert state(sim, 0.5).header.stamp.nanosec == 500_000_000


def test_the_state_is_published_fifty_times_a_second() -> None:
    with simkit.load(world(**REAL)) as sim:
        subscription = sim.subscribe(STATE)
        sim.run(1.0)
        assert len(subscription.messages) == 50


def test_it_drains_from_the_first_command_on() -> None:
    with simkit.load(world(**PLAIN, power_load=90)) as sim:
        found = state(sim, 1.0)
        assert (found.charge, found.power_supply_status) == (pytest.approx(0.01), 4), "full, and nothing moves"
        sim.publish("/model/r/joint/j/cmd_vel", {"data": 1.0})
        sim.run(0.5)
        sim.publish("/model/r/joint/j/cmd_vel", {"data": 0.0})
        found = state(sim, 0.5)
        assert (found.charge, found.power_supply_status) == (pytest.approx(0.0075, rel=2e-3), 2), "and does not stop"


def test_topics_start_and_stop_the_draining() -> None:
    topics = "<power_draining_topic>/on</power_draining_topic>"
    topics += "<stop_power_draining_topic>/off</stop_power_draining_topic>"
    with simkit.load(world(topics, **PLAIN, power_load=90)) as sim:
        on, off = (sim.communication.bus.advertise(topic, "std_msgs/msg/String") for topic in ("/on", "/off"))
        on.publish(simkit.msgs.make("std_msgs/msg/String"))
        assert state(sim, 1.0).charge == pytest.approx(0.0075, rel=1e-4)
        off.publish(simkit.msgs.make("std_msgs/msg/String"))
        assert state(sim, 1.0).charge == pytest.approx(0.0075, rel=1e-4)


def test_an_empty_battery_disables_the_joints_until_it_is_charged() -> None:
    recharge = {"enable_recharge": "true", "charging_time": 0.0005}
    with simkit.load(world(**PLAIN, **recharge, power_load=72)) as sim:
        sim.publish("/model/r/joint/j/cmd_vel", {"data": 2.0})
        sim.run(4.0)
        assert sim.joint("r::j").velocity == pytest.approx(2.0, rel=1e-3)
        sim.run(1.1)  # 7.2 A for 5 s are 0.01 A·h
        assert state(sim, 0.05).charge == pytest.approx(0.0, abs=1e-5)
        sim.publish("/model/r/joint/j/cmd_vel", {"data": -2.0})
        sim.run(0.5)
        assert sim.joint("r::j").velocity == pytest.approx(2.0, rel=1e-3), "it coasts"
        sim.joint("r::j").set_effort(5.0)
        sim.run(0.01)
        assert sim.joint("r::j").velocity == pytest.approx(2.0, rel=1e-3)
        snapshot = sim.snapshot()
        for _ in range(2):
            assert sim.call("/model/r/battery/main/recharge/start", {"data": True}).success
            sim.run(0.5)
            assert sim.joint("r::j").velocity == pytest.approx(-2.0, rel=1e-3), "it obeys again"
            sim.restore(snapshot)
        sim.reset()
        sim.publish("/model/r/joint/j/cmd_vel", {"data": 1.0})
        sim.run(0.5)
        assert sim.joint("r::j").velocity == pytest.approx(1.0, rel=1e-3)


def test_a_charger_charges_up_to_nine_tenths() -> None:
    values = {**PLAIN, "initial_charge": 0.005, "enable_recharge": "true", "charging_time": 0.001, "power_load": 0}
    with simkit.load(world("<recharge_by_topic/>", **values)) as sim:
        sim.publish("/model/r/battery/main/recharge/start", {"data": True})
        # a thousandth of an hour for all of it: 3.6 s
        found = state(sim, 0.72)
        assert (found.charge, found.power_supply_status) == (pytest.approx(0.007, rel=1e-3), 1)
        assert found.current == pytest.approx(-10)
        assert state(sim, 3.0).charge == pytest.approx(0.009, rel=1e-3)
        sim.call("/model/r/battery/main/recharge/stop")
        assert state(sim, 0.1).power_supply_status == 4, "full, as gz has it"


def test_the_sign_of_the_current_can_be_inverted() -> None:
    with simkit.load(world(**PLAIN, power_load=90, start_draining=1, invert_current_sign="true")) as sim:
        assert state(sim, 0.5).current == pytest.approx(-9.0)


def test_the_load_is_a_live_parameter() -> None:
    with simkit.load(world(**PLAIN, power_load=0, start_draining=1)) as sim:
        (node,) = [n for n in sim.communication.services.names() if n.endswith("battery/main/set_parameters")]
        value = {"name": "power_load", "value": {"type": 3, "double_value": 90.0}}
        assert sim.call(node, {"parameters": [value]}).results[0].successful
        assert state(sim, 1.0).charge == pytest.approx(0.0075, rel=1e-4)


def test_the_old_charge_calculation_of_gazebo_is_a_quirk() -> None:
    """Without the fix, Gazebo subtracts the last hundred currents at every step: a hundred times too much."""
    values = {**PLAIN, "power_load": 0.36, "start_draining": 1}
    with simkit.load(world(**values)) as sim:
        assert state(sim, 1.0).percentage == pytest.approx(1 - 0.001, rel=1e-6)
    with simkit.load(world(quirks=True, **values)) as sim:
        assert state(sim, 1.0).percentage == pytest.approx(1 - 0.001 * 95.05, rel=1e-3)


def test_wrong_numbers_are_reported() -> None:
    values = {**REAL, "initial_charge": 9, "smooth_current_tau": 0}
    del values["power_load"]
    with simkit.load(world(**values)) as sim:
        messages = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-123"]
        assert len(messages) == 3
        assert state(sim, 0.1).charge == pytest.approx(1.2009)
    with pytest.raises(LoadError) as raised:
        simkit.load(world(enable_recharge="true", power_load="much"))
    needed = "".join(d.message for d in raised.value.diagnostics)
    assert all(name in needed for name in ("voltage", "capacity", "charging_time"))


CLASSIC = """<plugin name="b" filename="libLinearBatteryPlugin.so"><link_name>b</link_name>
<battery_name>old</battery_name><open_circuit_voltage_constant_coef>10</open_circuit_voltage_constant_coef>
<initial_charge>0.01</initial_charge><capacity>0.01</capacity><smooth_current_tau>1e-9</smooth_current_tau></plugin>"""


def consumer(battery: str, power: float) -> str:
    return f"""<plugin name="c{power:g}" filename="libLinearBatteryConsumerPlugin.so"><link_name>b</link_name>
    <battery_name>{battery}</battery_name><power_load>{power}</power_load></plugin>"""


def test_classics_battery_is_drained_by_its_consumers() -> None:
    other = consumer("old", 50) + CLASSIC + consumer("old", 40) + consumer("main", 90)
    with simkit.load(world(**PLAIN, power_load=0, start_draining=1, other=other)) as sim:
        assert state(sim, 1.0, "/model/r/battery/old/state").charge == pytest.approx(0.0075, rel=1e-4)
        assert state(sim, 0.1).charge == pytest.approx(0.01 - 1.1 * 9 / 3600, rel=2e-2), "and so is gz's"


def test_a_consumer_without_a_battery_is_a_warning() -> None:
    with simkit.load(world(**REAL, other=consumer("mian", 1))) as sim:
        (warning,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-123"]
        assert "main" in warning.hint


@pytest.mark.parametrize(("is_asked_for", "scans"), [("true", 6), ("false", 11)])
def test_gpu_lidars_stop_while_the_battery_is_empty_if_the_world_enables_this(is_asked_for: str, scans: int) -> None:
    lidar = """<sensor name="eye" type="gpu_lidar"><update_rate>10</update_rate><lidar><scan><horizontal>
    <samples>4</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan><range><min>0.1</min>
    <max>9</max></range></lidar></sensor><sensor name="imu" type="imu"><update_rate>10</update_rate></sensor>"""
    sensors = f"""<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors">
    <disable_on_drained_battery>{is_asked_for}</disable_on_drained_battery></plugin>"""
    # 36 A take the 0.005 A·h in half a second, with the last step of which it is empty
    text = world(**PLAIN, initial_charge=0.005, power_load=360, start_draining=1)
    text = text.replace("</link><link", f"{lidar}</link><link", 1).replace("<model", f"{sensors}<model", 1)
    with simkit.load(text) as sim:
        scan, imu = (sim.subscribe(sim.sensor(f"r::b::{name}").topic) for name in ("eye", "imu"))
        sim.run(1.0)
        assert len(scan.messages) == scans
        assert len(imu.messages) == 11, "of another system"


def test_a_duplicate_battery_name_is_an_error() -> None:
    again = f"<plugin {GZ}><battery_name>main</battery_name><voltage>9</voltage><capacity>1</capacity></plugin>"
    recharge = {"enable_recharge": "true", "charging_time": 1}
    with pytest.raises(LoadError, match="the model already has a battery 'main'"):
        simkit.load(world(**REAL, **recharge, other=again))
    with pytest.raises(LoadError, match="found <battery_name></battery_name>; expected a name"):
        simkit.load(world(**REAL, other=again.replace(">main<", "><")))
