"""The infrared signals of the docking station of a Kobuki base, and a docking by these signals alone."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from typing import Any

import pytest

import simkit

NEAR = {"left": 1, "center": 2, "right": 4}
FAR = {"left": 16, "center": 8, "right": 32}
DOCK = "/mobile_base/sensors/dock_ir"
VELOCITY = "/mobile_base/commands/velocity"


STATION = simkit.Pose.from_rpy(1, 2, 0, 0, 0, 0.5)


def at(x: float, y: float, heading: float) -> simkit.Pose:
    """Return the pose in the world of a pose in the frame of the station."""
    return STATION @ simkit.Pose.from_rpy(x, y, 0, 0, 0, heading)


def load(x: float, y: float, heading: float) -> simkit.Simulation:
    """Load a TurtleBot 2 at a pose in the frame of its docking station, which is turned and shifted in the world."""
    place = at(x, y, heading)
    pose = " ".join(map(str, (*place.position, *place.rpy)))
    return simkit.load(
        f"""<sdf version='1.9'><world name='w'><physics type='ode'><max_step_size>0.002</max_step_size></physics>
        <include><uri>model://ground_plane</uri></include>
        <include><uri>model://kobuki_dock</uri><pose>1 2 0 0 0 0.5</pose></include>
        <include><uri>model://turtlebot2</uri><pose>{pose}</pose></include></world></sdf>"""
    )


@pytest.fixture(scope="module")
def sim() -> Iterator[simkit.Simulation]:
    with load(2, 0, 0) as sim:
        yield sim


@pytest.mark.parametrize(
    ("x", "y", "heading", "expected"),
    [
        (1.5, 0.0, math.pi, (0, FAR["center"], 0)),
        (0.5, 0.0, math.pi, (0, NEAR["center"], 0)),
        (1.5, 1.0, math.pi + 0.6, (0, FAR["left"], 0)),
        (1.5, -1.0, math.pi - 0.6, (0, FAR["right"], 0)),
        (1.5, 1.0, math.pi + 0.6 + math.pi / 3, (FAR["left"], 0, 0)),
        (1.5, -1.0, math.pi - 0.6 - math.pi / 3, (0, 0, FAR["right"])),
        (1.5, 0.2, math.pi, (0, FAR["left"] | FAR["center"], 0)),
        (0.75, 0.0, math.pi, (0, NEAR["center"] | FAR["center"], 0)),
        (1.5, 0.0, 0.0, (0, 0, 0)),
        (4.0, 0.0, math.pi, (0, 0, 0)),
        (-1.0, 0.0, 0.0, (0, 0, 0)),
    ],
)
def test_each_receiver_gets_the_signal_of_the_region_that_it_is_in(
    sim: simkit.Simulation, x: float, y: float, heading: float, expected: tuple[int, int, int]
) -> None:
    signals = sim.subscribe(DOCK, keep=1)
    sim.model("turtlebot2").set_pose(at(x, y, heading))
    sim.run(0.02)
    assert tuple(signals.latest.data) == expected


def test_without_a_station_there_are_no_signals_until_one_is_spawned() -> None:
    with simkit.load("turtlebot2_empty") as sim:
        signals = sim.subscribe(DOCK, keep=1)
        sim.run(0.04)
        assert list(signals.latest.data) == [0, 0, 0]
        assert [d.severity for d in sim.diagnostics if "kobuki_dock" in d.message] == ["note"]
        sim.spawn("kobuki_dock", name="kobuki_dock", pose=simkit.Pose.from_rpy(1.5, 0, 0, 0, 0, math.pi))
        sim.run(0.04)
        assert list(signals.latest.data) == [0, FAR["center"], 0]


class Docking:
    """State machine of a docking: find the station, drive to its middle line, turn to it and approach it.

    The states are those of the driver of the real base. Signals are collected over 0.4 s.
    """

    def __init__(self) -> None:
        self.state, self.balance, self.turned = "scan", 0, 0.0
        self._recent: deque[list[int]] = deque(maxlen=20)

    def step(self, data: Any, heading_change: float) -> tuple[float, float]:
        """Return the forward speed [m/s] and the turning rate [rad/s]."""
        self._recent.append([int(bits) for bits in data])
        right, middle, left = (self._collected(i) for i in range(3))
        sides = {name: NEAR[name] | FAR[name] for name in NEAR}
        if self.state == "scan":
            self.turned += heading_change
            if middle & sides["center"]:
                self.state = "aligned"
                return 0.05, 0.0
            self.balance += bool(middle & sides["right"]) - bool(middle & sides["left"])
            if abs(self.turned) > 2 * math.pi:
                self.state = "find"
            return 0.0, 0.66
        from_right = self.balance > 0
        own, other = ("right", "left") if from_right else ("left", "right")
        seen = left if from_right else right
        if self.state == "find":
            if seen & sides[own]:
                self.state = "cross"
            return 0.0, -0.33 if from_right else 0.33
        if self.state == "cross":
            if seen & sides[other]:
                self.state, self.balance, self.turned = "scan", 0, 0.0
            return 0.05, 0.0
        return self._approach(middle)

    def _approach(self, middle: int) -> tuple[float, float]:
        for bits, speed, rate in ((NEAR, 0.05, 0.1), (FAR, 0.1, 0.3)):
            seen = middle & sum(bits.values())
            if seen in (bits["center"], sum(bits.values())):
                return speed, 0.0
            if seen:
                return speed, rate if seen & bits["left"] else -rate
        self.state, self.balance, self.turned = "scan", 0, 0.0
        return 0.0, 0.66

    def _collected(self, receiver: int) -> int:
        found = 0
        for bits in self._recent:
            found |= bits[receiver]
        return found


@pytest.mark.slow
@pytest.mark.parametrize(("x", "y", "heading"), [(1.5, 0.0, 2.5), (1.2, 0.5, 0.0), (1.2, -0.5, 2.0)])
def test_a_robot_docks_by_the_signals_alone(x: float, y: float, heading: float) -> None:
    with load(x, y, heading) as sim:
        signals, states = sim.subscribe(DOCK, keep=1), sim.subscribe("/mobile_base/sensors/core", keep=1)
        robot, docking = sim.model("turtlebot2"), Docking()
        sim.run(0.04)
        yaw = robot.pose.rpy[2]
        while not states.latest.charger and sim.time < 150:
            change = math.remainder(robot.pose.rpy[2] - yaw, 2 * math.pi)
            yaw += change
            forward, turn = docking.step(signals.latest.data, change)
            sim.publish(VELOCITY, {"linear": {"x": forward}, "angular": {"z": turn}})
            sim.run(0.02)
        assert states.latest.charger == 6
        place = sim.model("kobuki_dock").pose.inverse() @ robot.pose
        assert place.position[:2] == pytest.approx((0.19, 0), abs=0.03)
