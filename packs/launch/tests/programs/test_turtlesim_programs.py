"""Known programs of turtlesim: each node has a square of its own in one world."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import simkit
from simkit import Simulation

MIDDLE = 5.544445


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load("turtlesim_board") as simulation:
        yield simulation


def test_a_node_without_namespace_has_the_topics_and_models_of_the_world_turtlesim(sim: Simulation) -> None:
    sim.add_node("turtlesim/turtlesim_node", params={"background_r": 150})
    sim.run(0.1)
    sim.publish("/turtle1/cmd_vel", {"linear": {"x": 2.0}})
    sim.run(1.2)
    assert sim.model("turtle1").pose.position[0] == pytest.approx(MIDDLE + 2.0, abs=0.04)
    assert sim.call("/spawn", {"x": 2.0, "y": 3.0, "name": "leo"}).name == "leo"
    sim.run(0.1)
    assert "leo" in sim.models
    values = sim.call("/turtlesim/get_parameters", {"names": ["background_r"]}).values
    assert values[0].integer_value == 150


def test_the_mimic_of_the_tutorial_drives_the_turtle_of_the_second_node(sim: Simulation) -> None:
    for number in (1, 2):
        sim.add_node("turtlesim/turtlesim_node", name="sim", namespace=f"turtlesim{number}", label=f"sim{number}")
    remap = {"/input/pose": "/turtlesim1/turtle1/pose", "/output/cmd_vel": "/turtlesim2/turtle1/cmd_vel"}
    sim.add_node("turtlesim/mimic", name="mimic", remap=remap)
    sim.run(0.1)
    sim.publish("/turtlesim1/turtle1/cmd_vel", {"linear": {"x": 2.0}, "angular": {"z": -1.8}})
    sim.run(2.5)
    first, second = (sim.model(f"turtlesim{number}_sim_turtle1").pose for number in (1, 2))
    assert first.position[0] > MIDDLE + 0.3
    assert second.position[:2] == pytest.approx(first.position[:2] - [0.0, 12.0], abs=0.05)


def test_the_arrow_keys_drive_a_turtle(sim: Simulation) -> None:
    sim.add_node("turtlesim/turtlesim_node")
    node = sim.add_node("turtlesim/turtle_teleop_key", keys=[(0.5, "\x1b[A"), (2.0, "g"), (3.0, "q")])
    sim.run(4.0)
    assert sim.model("turtle1").pose.position[0] == pytest.approx(MIDDLE + 2.0, abs=0.04)
    assert node.done
    assert node.exit_code == 0


def test_without_keys_the_teleop_waits(sim: Simulation) -> None:
    node = sim.add_node("turtlesim/turtle_teleop_key")
    sim.run(1.0)
    assert not node.done


def test_draw_square_drives_a_side_and_turns(sim: Simulation) -> None:
    sim.add_node("turtlesim/turtlesim_node")
    node = sim.add_node("turtlesim/draw_square")
    sim.run(8.5)
    goals = [line for line in node.log if "New goal" in line]
    assert [line.partition("New goal ")[2] for line in goals[:2]] == [
        "[7.544445 5.544445, 0.000000]",
        "[7.464445 5.544445, 1.570796]",
    ]
    assert sim.model("turtle1").pose.position[1] > 7.0
