"""The motors of Teeterbot: the speed without a load, the stall torque, the loops of torque and speed, and a fall."""

from __future__ import annotations

import pytest
from plugin_worlds import element, world

import simkit

INERTIA = "<inertial><mass>{}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>"


def robot(**values: object) -> simkit.Simulation:
    """Load a heavy body in the air with two wheels of 0.02 kg m2."""
    wheels = "".join(
        f"""<link name='{s}_wheel'>{INERTIA.format(1, i=0.02)}</link><joint name='{s}_wheel_joint' type='continuous'>
        <parent>base_link</parent><child>{s}_wheel</child><axis><xyz>0 1 0</xyz></axis></joint>"""
        for s in ("left", "right")
    )
    plugin = element("plugin", values, "name='motors' filename='libteeterbot_gazebo_plugin.so'")
    body = f"<link name='base_link'>{INERTIA.format(1e4, i=1e4)}</link>"
    return simkit.load(world(f"<gravity>0 0 0</gravity><model name='bot'>{body}{wheels}{plugin}</model>", step=0.001))


def test_a_voltage_turns_a_free_wheel_until_its_voltage_of_induction_is_the_same() -> None:
    with robot(voltageMode=1) as sim:
        speeds, currents = sim.subscribe("/bot/left_wheel_speed"), sim.subscribe("/bot/right_current")
        sim.publish("/bot/left_motor_voltage", {"data": 7.0})
        sim.run(2.0)
        assert speeds.latest.data == pytest.approx(7.0 / 0.35, rel=0.01)
        assert currents.latest.data == pytest.approx(0.0, abs=0.01)
        assert len(speeds.messages) == pytest.approx(200, abs=1)


def test_the_current_of_a_motor_is_limited() -> None:
    with robot(voltageMode=1) as sim:
        sim.publish("/bot/left_motor_voltage", {"data": 1000.0})
        sim.run(0.2)
        # 30 A of 0.35 N m/A on 0.02 kg m2
        assert float(sim.joint("bot::left_wheel_joint").velocity) == pytest.approx(0.2 * 30 * 0.35 / 0.02, rel=0.02)


def test_the_loop_of_the_speed_reaches_a_speed_and_a_snapshot_keeps_its_state() -> None:
    with robot(speedMode=1) as sim:
        sim.publish("/bot/right_speed_cmd", {"data": 5.0})
        sim.run(0.3)
        snapshot = sim.snapshot()
        sim.run(8.0)
        speed = float(sim.joint("bot::right_wheel_joint").velocity)
        assert speed == pytest.approx(5.0, abs=0.1)
        sim.restore(snapshot)
        sim.run(8.0)
        assert float(sim.joint("bot::right_wheel_joint").velocity) == speed


def test_a_fall_is_published() -> None:
    with robot() as sim:
        fallen = sim.subscribe("/bot/fallen_over")
        sim.model("bot").set_pose(simkit.Pose.from_rpy(0, 0, 0, 0, 1.0, 0))
        sim.run(0.01)
        assert fallen.latest.data is True
