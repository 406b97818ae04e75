"""Turtles of turtlesim: every topic, service, action and parameter has the effect that ROS 2's node has."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.bridges.teleop import Teleop, find_target

MIDDLE = 5.544445
SIZE = 499 / 45
BACKGROUND = (69, 86, 255)
PEN = (0xB3, 0xB8, 0xFF)


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load("turtlesim") as loaded:
        yield loaded


def pose(sim: simkit.Simulation, name: str = "turtle1") -> tuple[float, float, float]:
    """Return x, y and theta of the model, after one more update."""
    sim.step(1)
    model = sim.model(name).pose
    return float(model.position[0]), float(model.position[1]), model.rpy[2]


def drive(sim: simkit.Simulation, name: str = "turtle1", time: float = 1.5, **velocity: float) -> None:
    linear = {axis: velocity.get(axis, 0.0) for axis in ("x", "y")}
    sim.publish(f"/{name}/cmd_vel", {"linear": linear, "angular": {"z": velocity.get("turn", 0.0)}})
    sim.run(time)


def window(sim: simkit.Simulation) -> Any:
    image = sim.subscribe("/turtlesim/image", keep=1)
    sim.run(0.2)
    image.close()
    message = image.messages[-1]
    return np.asarray(message.data).reshape(message.height, message.width, 3)


def colours(sim: simkit.Simulation) -> set[tuple[int, int, int]]:
    return {tuple(int(v) for v in colour) for colour in np.unique(window(sim).reshape(-1, 3), axis=0)}


def test_the_first_turtle_stands_in_the_middle_and_tells_its_pose(sim: simkit.Simulation) -> None:
    poses = sim.subscribe("/turtle1/pose", keep=100)
    sim.run(0.8)
    assert len(poses.messages) == 50  # 62.5 Hz
    newest = poses.messages[-1]
    assert (newest.x, newest.y) == pytest.approx((MIDDLE, MIDDLE))
    assert (newest.theta, newest.linear_velocity, newest.angular_velocity) == (0.0, 0.0, 0.0)


def test_a_command_lasts_one_second(sim: simkit.Simulation) -> None:
    drive(sim, x=2.0, time=3.0)
    assert pose(sim) == pytest.approx((MIDDLE + 2.0, MIDDLE, 0.0), abs=2.0 * 0.016)
    drive(sim, turn=1.0, time=3.0)
    assert pose(sim)[2] == pytest.approx(1.0, abs=0.016)


def test_commands_together_drive_a_circle_of_their_ratio(sim: simkit.Simulation) -> None:
    places = []
    for _ in range(16):
        drive(sim, x=1.0, turn=1.0, time=0.4)
        places.append(pose(sim)[:2])
    distances = np.linalg.norm(np.array(places) - (MIDDLE, MIDDLE + 1.0), axis=1)
    np.testing.assert_allclose(distances, 1.0, atol=0.02)


def test_sideways_commands_have_an_effect_only_on_holonomic_turtles(sim: simkit.Simulation) -> None:
    drive(sim, y=1.0)
    assert pose(sim)[:2] == pytest.approx((MIDDLE, MIDDLE))
    sim.set_parameter("/turtlesim", "holonomic", True)
    drive(sim, y=1.0)
    assert pose(sim)[:2] == pytest.approx((MIDDLE, MIDDLE + 1.0), abs=0.02)


def test_a_driven_square_closes(sim: simkit.Simulation) -> None:
    for side in range(4):
        sim.call("/turtle1/teleport_relative", {"linear": 2.0, "angular": 0.0})
        goal = sim.send_goal("/turtle1/rotate_absolute", {"theta": math.remainder((side + 1) * math.pi / 2, math.tau)})
        sim.run_until(lambda _, goal=goal: goal.is_done, timeout=5.0)
        assert goal.status.name == "SUCCEEDED"
        corner = pose(sim)
        sim.call("/turtle1/teleport_absolute", {"x": corner[0], "y": corner[1], "theta": (side + 1) * math.pi / 2})
    assert math.dist(pose(sim)[:2], (MIDDLE, MIDDLE)) < 0.01


def test_turtles_stop_at_the_walls_and_say_so(sim: simkit.Simulation) -> None:
    logs = sim.subscribe("/rosout", keep=100)
    for _ in range(4):
        drive(sim, x=3.0, time=0.9)
    assert pose(sim)[0] == pytest.approx(SIZE, abs=1e-9)
    assert any("Oh no! I hit the wall!" in log.msg for log in logs.messages)


def test_the_action_turns_the_shorter_way_and_tells_what_remains(sim: simkit.Simulation) -> None:
    goal = sim.send_goal("/turtle1/rotate_absolute", {"theta": -2.5})
    sim.run(0.5)
    assert goal.feedback.remaining == pytest.approx(-2.0, abs=0.04)
    sim.run(2.5)
    assert goal.status.name == "SUCCEEDED"
    assert goal.result.delta == pytest.approx(2.5, abs=0.02)  # the begin minus the end, as in turtlesim
    assert pose(sim)[2] == pytest.approx(-2.5, abs=0.02)


def test_a_second_goal_aborts_the_first_and_a_cancelled_one_stops(sim: simkit.Simulation) -> None:
    first = sim.send_goal("/turtle1/rotate_absolute", {"theta": 3.0})
    sim.run(0.5)
    second = sim.send_goal("/turtle1/rotate_absolute", {"theta": -1.0})
    sim.run(0.2)
    assert (first.status.name, second.is_active) == ("ABORTED", True)
    second.cancel()
    sim.run(0.1)
    heading = pose(sim)[2]
    sim.run(1.0)
    assert second.status.name == "CANCELED"
    assert pose(sim)[2] == pytest.approx(heading, abs=1e-9)


def test_spawned_turtles_have_their_own_topics_until_they_are_killed(sim: simkit.Simulation) -> None:
    assert sim.call("/spawn", {"x": 2.0, "y": 3.0, "theta": 0.5}).name == "turtle2"
    assert sim.call("/spawn", {"x": 1.0, "y": 1.0, "name": "leo"}).name == "leo"
    assert pose(sim, "turtle2") == pytest.approx((2.0, 3.0, 0.5))
    drive(sim, "leo", x=1.0)
    assert pose(sim, "leo")[0] == pytest.approx(2.0, abs=0.02)
    sim.call("/kill", {"name": "turtle2"})
    sim.run(0.1)
    assert "turtle2" not in sim.models and not any("turtle2" in topic for topic in sim.topics())
    assert any("/leo/" in topic for topic in sim.topics())


@pytest.mark.parametrize(
    ("service", "request_", "told"),
    [
        ("/spawn", {"name": "turtle1"}, "A turtle named [turtle1] already exists"),
        ("/spawn", {"name": "square"}, "A turtle named [square] already exists"),
        ("/spawn", {"name": "a/b"}, "Cannot spawn turtle 'a/b'"),
        ("/spawn", {"x": math.nan}, "Cannot spawn turtle 'turtle2'"),
        ("/kill", {"name": "nobody"}, "Tried to kill turtle [nobody], which does not exist"),
        ("/turtle1/teleport_absolute", {"x": math.inf}, "NaN or infinite"),
    ],
)
def test_requests_without_a_meaning_are_refused_in_the_log(
    sim: simkit.Simulation, service: str, request_: dict[str, Any], told: str
) -> None:
    logs = sim.subscribe("/rosout", keep=10)
    response = sim.call(service, request_)
    sim.run(0.1)
    assert getattr(response, "name", "") == ""
    assert any(told in log.msg for log in logs.messages)
    assert pose(sim) == pytest.approx((MIDDLE, MIDDLE, 0.0))
    assert set(sim.models) == {"square", "turtle1"}


@pytest.mark.slow
def test_the_background_changes_at_once_below_the_trails_of_pens_which_clear_wipes(sim: simkit.Simulation) -> None:
    assert colours(sim) - {BACKGROUND} and PEN not in colours(sim)  # the turtle is drawn, too
    drive(sim, x=2.0)
    assert PEN in colours(sim)
    sim.call("/turtle1/set_pen", {"r": 255, "g": 10, "b": 0, "width": 5})
    drive(sim, x=2.0)
    assert (255, 10, 0) in colours(sim)
    sim.set_parameter("/turtlesim", "background_r", 200)
    found = colours(sim)
    assert {(200, *BACKGROUND[1:]), PEN, (255, 10, 0)} <= found and BACKGROUND not in found  # trails stay
    sim.call("/clear")
    found = colours(sim)
    assert (200, *BACKGROUND[1:]) in found and not found & {PEN, (255, 10, 0), BACKGROUND}
    sim.call("/turtle1/set_pen", {"off": 1})
    drive(sim, x=-2.0)
    assert colours(sim) == found


def test_the_colour_sensor_sees_what_is_below_the_turtle(sim: simkit.Simulation) -> None:
    seen = sim.subscribe("/turtle1/color_sensor", keep=1)
    sim.run(0.1)
    assert (seen.latest.r, seen.latest.g, seen.latest.b) == BACKGROUND
    drive(sim, x=1.0)
    drive(sim, x=-1.0, time=0.5)
    assert (seen.latest.r, seen.latest.g, seen.latest.b) == PEN


@pytest.mark.parametrize("way", ["service", "simulation"])
def test_a_reset_leaves_one_turtle_in_the_middle(sim: simkit.Simulation, way: str) -> None:
    sim.call("/spawn", {"x": 2.0, "y": 3.0})
    drive(sim, x=1.0)
    if way == "service":
        sim.call("/reset")
    else:
        sim.reset()
    assert pose(sim) == pytest.approx((MIDDLE, MIDDLE, 0.0))
    assert set(sim.models) == {"square", "turtle1"}
    assert PEN not in colours(sim)
    assert not any("turtle2" in topic for topic in sim.topics())


def test_a_restored_snapshot_has_its_turtles_and_their_topics_again(sim: simkit.Simulation) -> None:
    sim.call("/spawn", {"x": 2.0, "y": 3.0})
    sim.run(0.1)
    kept = sim.snapshot()
    sim.call("/kill", {"name": "turtle2"})
    sim.call("/spawn", {"x": 4.0, "y": 4.0, "name": "leo"})
    sim.run(0.1)
    sim.restore(kept)
    drive(sim, "turtle2", x=1.0)
    assert pose(sim, "turtle2")[0] == pytest.approx(3.0, abs=0.02)
    assert set(sim.models) == {"square", "turtle1", "turtle2"}
    assert not any("/leo/" in topic for topic in sim.topics())


def test_a_removed_model_removes_its_turtle(sim: simkit.Simulation) -> None:
    sim.call("/spawn", {"x": 2.0, "y": 3.0})
    sim.run(0.1)
    sim.remove("turtle2")
    sim.run(0.1)
    assert set(sim.models) == {"square", "turtle1"}
    assert not any("turtle2" in topic for topic in sim.topics())


def test_the_keys_of_teleop_are_those_of_turtle_teleop_key(sim: simkit.Simulation) -> None:
    teleop = Teleop(sim, find_target(sim))
    assert teleop.press("up") and not teleop.press("w")
    sim.run(1.5)
    assert pose(sim) == pytest.approx((MIDDLE + 2.0, MIDDLE, 0.0), abs=0.04)  # 2 m/s for 1 s
    teleop.press("left")
    sim.run(1.5)
    assert pose(sim)[2] == pytest.approx(2.0, abs=0.04)
    for key, heading in zip("gtredcvb", (0, 45, 90, 135, 180, -135, -90, -45), strict=True):
        teleop.press(key.upper())
        sim.run(3.5)
        assert math.cos(pose(sim)[2] - math.radians(heading)) == pytest.approx(1.0, abs=3e-4)
    teleop.press("d")
    sim.run(0.5)
    teleop.press("f")
    sim.run(0.5)
    assert math.degrees(pose(sim)[2]) == pytest.approx(-45 - 0.5 * 57.3, abs=3.0)  # the turn at 1 rad/s was cancelled
    assert teleop.press("q") and not teleop.press("up")


def test_teleop_of_another_turtle_turns_that_turtle(sim: simkit.Simulation) -> None:
    sim.call("/spawn", {"x": 2.0, "y": 3.0})
    teleop = Teleop(sim, find_target(sim, "/turtle2/cmd_vel"))
    teleop.press("r")
    sim.run(2.0)
    assert pose(sim, "turtle2")[2] == pytest.approx(math.pi / 2, abs=0.03)
    assert pose(sim)[2] == 0.0


MIMIC = Path(__file__).parents[3] / "labs" / "01_turtlesim" / "mimic.sdf"


def test_a_mimic_makes_a_second_turtle_draw_the_same_arc() -> None:
    """Each pose is passed on one update of 16 ms later; the command of 1 s ends with the last pose that moves."""
    with simkit.load("turtlesim", spawn=[str(MIMIC)]) as sim:
        assert sim.call("/spawn", {"x": 2.0, "y": 2.0, "theta": 1.0, "name": "turtle2"}).name == "turtle2"
        sim.step(2)
        first, second = sim.model("turtle1").pose, sim.model("turtle2").pose
        drive(sim, x=2.0, turn=1.2, time=2.5)
        arcs = [before.inverse() @ sim.model(name).pose for name, before in (("turtle1", first), ("turtle2", second))]
        assert math.dist(arcs[0].position, arcs[1].position) < 0.04  # 16 ms at 2 m/s
        assert arcs[0].rpy[2] == pytest.approx(1.2, abs=0.02)
        assert arcs[1].rpy[2] == pytest.approx(arcs[0].rpy[2], abs=0.02)
