"""Kinetic energy monitor of Gazebo against ½mv² + ½ω·Iω."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import LoadError

INERTIAL = """<inertial><pose>0.1 0 0 0 0 0</pose><mass>2</mass>
<inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz></inertia></inertial>"""


def world(more: str = "", link: str = "l", pose: str = "0 0 1 0 0 0") -> str:
    kind = 'filename="gz-sim-kinetic-energy-monitor-system" name="gz::sim::systems::KineticEnergyMonitor"'
    plugin = f"<plugin {kind}><link_name>{link}</link_name>{more}</plugin>"
    inner = f'<model name="inner"><link name="deep">{INERTIAL}</link></model>'
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m"><pose>{pose}</pose>
    <link name="l">{INERTIAL}</link>{inner}{plugin}</model></world></sdf>"""


def losses(sim: Any, topic: str = "/model/m/kinetic_energy") -> list[tuple[int, float]]:
    found: list[tuple[int, float]] = []
    sim.subscribe(topic, lambda message: found.append((sim.tick, message.data)))
    return found


@pytest.mark.parametrize("pose", ["0 0 1 0 0 0", "0 0 1 0.3 -0.7 1.1"])
def test_the_energy_that_a_link_loses_in_a_step_is_published(pose: str) -> None:
    with simkit.load(world(pose=pose)) as sim:
        found = losses(sim)
        turn = simkit.Pose.from_rpy(*map(float, pose.split()))
        # along the link's x through its centre of mass, and about that axis: both stay as they are
        axis = (turn @ simkit.Pose((1, 0, 0))).position - turn.position
        sim.link("m::l").set_velocity(3 * axis, 4 * axis)
        sim.run(0.02)
        assert not found
        sim.link("m::l").set_velocity((0, 0, 0))
        sim.run(0.02)
        assert found == [(21, pytest.approx(0.5 * 2 * 9 + 0.5 * 0.1 * 16, rel=1e-6))]


def test_the_energy_uses_the_velocity_of_the_centre_of_mass() -> None:
    with simkit.load(world("<kinetic_energy_threshold>0.1</kinetic_energy_threshold>")) as sim:
        found = losses(sim)
        sim.link("m::l").set_velocity((0, 0, 0), (0, 0, 5))  # about the origin: the centre moves at 0.5 m/s
        sim.run(0.001)
        sim.link("m::l").set_velocity((0, 0, 0))
        sim.run(0.001)
        assert found == [(2, pytest.approx(0.5 * 2 * 0.25 + 0.5 * 0.3 * 25, rel=1e-4))]


def test_losses_below_the_threshold_and_gains_are_not_published() -> None:
    with simkit.load(world("<kinetic_energy_threshold>9.1</kinetic_energy_threshold>")) as sim:
        found = losses(sim)
        for speed in (3, 0, 3.1, 0):
            sim.link("m::l").set_velocity((speed, 0, 0))
            sim.run(0.001)
        assert [tick for tick, _ in found] == [4]


def test_the_time_of_subscription_changes_no_event() -> None:
    with simkit.load(world()) as sim:
        sim.link("m::l").set_velocity((3, 0, 0))
        sim.run(0.01)
        late = losses(sim)
        sim.link("m::l").set_velocity((0, 0, 0))
        sim.run(0.001)
        assert late == [(11, pytest.approx(9.0))]
        sim.reset()
        late.clear()
        sim.link("m::l").set_velocity((3, 0, 0))
        sim.run(0.01)
        sim.link("m::l").set_velocity((0, 0, 0))
        sim.run(0.001)
        assert late == [(11, pytest.approx(9.0))]


def test_a_restored_run_publishes_the_same() -> None:
    with simkit.load(world()) as sim:
        sim.link("m::l").set_velocity((3, 0, 0))
        sim.run(0.01)
        found = losses(sim)
        sim.run(0.001)
        snapshot = sim.snapshot()
        for _ in range(2):
            sim.link("m::l").set_velocity((0, 0, 0))
            sim.run(0.01)
            sim.restore(snapshot)
        assert found == [(12, pytest.approx(9.0))] * 2


def test_topic_nested_links_and_missing_ones() -> None:
    with simkit.load(world("<topic>blow</topic>", link="deep")) as sim:
        found = losses(sim, "/blow")
        sim.link("m::inner::deep").set_velocity((3, 0, 0))
        sim.run(0.001)
        sim.link("m::inner::deep").set_velocity((0, 0, 0))
        sim.run(0.001)
        assert found == [(2, pytest.approx(9.0))]
    with pytest.raises(LoadError, match="'l', 'deep'|'deep', 'l'"):
        simkit.load(world(link="lnk"))


def test_an_empty_link_name_and_a_topic_without_a_letter_are_errors() -> None:
    with pytest.raises(LoadError, match="has no link ''"):
        simkit.load(world(link=""))
    with pytest.raises(LoadError, match="found <topic>ü</topic>; expected a name with a letter or a digit"):
        simkit.load(world("<topic>ü</topic>"))
    with simkit.load(world("<topic/>")) as sim:  # as in gz, the default
        assert "/model/m/kinetic_energy" in sim.topics()
        assert "/" not in sim.topics()
