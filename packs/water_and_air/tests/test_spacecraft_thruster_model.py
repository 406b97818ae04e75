"""On-off thruster: impulse of a duty cycle, direction, missing commands."""

from __future__ import annotations

import math

import pytest

import simkit

MASS, THRUST = 12.0, 1.5
PLUGIN = 'filename="gz-sim-spacecraft-thruster-model-system" name="gz::sim::systems::SpacecraftThrusterModel"'


def world(parameters: str = "", pose: str = "0 0 0 0 0 0") -> str:
    return f"""<sdf version="1.9"><world name="space"><gravity>0 0 0</gravity><model name="craft">
      <link name="body"><pose>{pose}</pose><inertial><mass>{MASS}</mass>
        <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
      <plugin {PLUGIN}><link_name>body</link_name><actuator_number>1</actuator_number>
        <max_thrust>{THRUST}</max_thrust><topic>craft</topic><sub_topic>thrusters</sub_topic>{parameters}</plugin>
      </model></world></sdf>"""


def command(sim: simkit.Simulation, *shares: float) -> None:
    sim.publish("/craft/thrusters", {"normalized": list(shares)})


@pytest.mark.parametrize("share", [0.0, 0.25, 0.6, 1.0, 3.0])
def test_the_impulse_is_the_share_of_the_full_thrust(share: float) -> None:
    with simkit.load(world()) as sim:
        command(sim, 0.0, share)
        sim.run(2.0)
        speed = sim.link("craft::body").linear_velocity[2]
        assert speed == pytest.approx(min(share, 1.0) * 2.0 * THRUST / MASS, rel=1e-2, abs=1e-12)


def test_pulses_have_the_full_thrust_along_the_axis_of_the_link() -> None:
    with simkit.load(world("<duty_cycle_frequency>2</duty_cycle_frequency>", f"0 0 0 {math.pi / 2} 0 0")) as sim:
        command(sim, 0.0, 0.4)
        sim.run(0.21)
        first = sim.link("craft::body").linear_velocity.tolist()
        assert first == pytest.approx([0, -0.2 * THRUST / MASS, 0], rel=2e-2, abs=1e-9)
        sim.run(0.28)
        assert sim.link("craft::body").linear_velocity.tolist() == first  # off until 0.5 s


def test_a_message_without_the_actuator_is_reported() -> None:
    with simkit.load(world()) as sim:
        command(sim, 1.0)
        sim.run(0.1)
        assert "SK-PLUGIN-041" in {found.code for found in sim.diagnostics}
        assert not sim.link("craft::body").linear_velocity.any()


def test_runs_after_a_restore_have_the_same_bits() -> None:
    with simkit.load(world()) as sim:
        command(sim, 0.0, 0.37)
        sim.run(0.515)
        saved = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(saved)
            sim.run(0.5)
            ends.append(float(sim.link("craft::body").pose.position[2]))
        assert ends[0] == ends[1]


def test_the_thrust_is_required() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001"):
        simkit.load(world().replace(f"<max_thrust>{THRUST}</max_thrust>", ""))
