"""Comparison of a part of a run with its repetition after a restore or a reset."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np

import simkit
from simkit import msgs
from simkit.runtime.engine.snapshot import state_hash
from simkit_verification.testing.certify.run_hashes import (
    attribute_hashes,
    plugin_attributes,
    short_hash,
    writable_state_hash,
)

_BOX = (
    '<sdf version="1.9"><model name="newcomer"><pose>0 0 60 0 0 0</pose><link name="l"><inertial><mass>1</mass>'
    '</inertial><collision name="c"><geometry><sphere><radius>.1</radius></sphere></geometry></collision></link>'
    "</model></sdf>"
)


@dataclasses.dataclass
class Seen:
    """Results of one part of a run.

    Attributes:
        physics: hashes of state and inputs at each step.
        messages: tick, topic and hash of each message.
        readings: sensor readings at the end.
        memory: hash of each plugin attribute at the end.
        parameters: parameter values at the end.
        state: state hash at the end.
    """

    physics: list[int]
    messages: list[tuple[int, str, int]]
    readings: dict[str, int]
    memory: dict[str, dict[str, int]]
    parameters: dict[str, object]
    state: str


class Runner:
    """Run a simulation: subscribe to all topics, and send random commands to every input."""

    def __init__(self, sim: simkit.Simulation, steps: int) -> None:
        self.sim, self._steps = sim, steps
        self._messages: list[tuple[int, str, int]] = []
        self._heard: set[str] = set()
        sim.communication.bus.on_topic(self._listen)
        takes = [(topic, types[0]) for topic, _, types, does in sim.communication.bus.endpoints() if does == "takes"]
        self._inputs = [(topic, kind) for topic, kind in takes if not topic.endswith(_NOT_SENT)]

    def _listen(self, topic: str, _: str) -> None:
        if topic not in self.sim.communication.bus.aside and topic not in self._heard:
            self._heard.add(topic)
            self.sim.subscribe(
                topic, lambda m: self._messages.append((self.sim.tick, topic, short_hash(msgs.serialize(m)))), 1
            )

    def run(self, seed: int) -> Seen:
        """Make some steps; send commands before some of the steps."""
        sim, random, physics = self.sim, np.random.default_rng(seed), []
        self._messages.clear()
        for part in range(6):
            if part in (0, 2, 3):
                self._command(random)
            if part == 1:
                self._set_parameters(random)
            sim.step(self._steps // 6)
            physics.append(writable_state_hash(sim.mj_data))
        return Seen(
            physics, list(self._messages), self._readings(), memory_of(sim), self._parameters(), state_hash(sim)
        )

    def _readings(self) -> dict[str, int]:
        return {name: _digest(sensor.latest) for name, sensor in self.sim.contents.sensors.items()}

    def _parameters(self) -> dict[str, object]:
        return {
            f"{node}.{name}": p.value
            for node, found in self.sim.communication.parameters.items()
            for name, p in found.items()
        }

    def _set_parameters(self, random: np.random.Generator) -> None:
        """Change every numeric parameter by a small amount."""
        for node, found in self.sim.communication.parameters.items():
            for name, parameter in found.items():
                if isinstance(parameter.value, float):
                    with suppress(simkit.errors.SimkitError):
                        self.sim.set_parameter(node, name, parameter.value * float(random.uniform(0.9, 1.1)))

    def _command(self, random: np.random.Generator) -> None:
        for topic, kind in self._inputs:
            given = _SENT[kind](random) if kind in _SENT else {}
            message = msgs.from_dict([kind], given)
            self.sim.publish(topic, message if given else _fill(message, random))
        if "/tf" in self.sim.topics():
            self.sim.publish("/tf", _frame(random))
        if "/play_motion2" in self.sim.communication.actions.names():
            self.sim.send_goal("/play_motion2", {"motion_name": "bow"})


def memory_of(sim: simkit.Simulation) -> dict[str, dict[str, int]]:
    """Return the hashes of all plugin attributes."""
    return {f"{p.scoped}::{p.name}": attribute_hashes(plugin_attributes(p)) for p in sim.engine.structure.all_plugins()}


def proven(
    sim: simkit.Simulation, steps: int = 60, begin: Callable[[simkit.Simulation], None] = lambda _: None
) -> tuple[dict[str, list[str]], tuple[Seen, Seen]]:
    """Run a part of a simulation, go back by restore and by reset, and run the part again.

    Args:
        sim: simulation before its first step.
        steps: number of steps of the part.
        begin: function that prepares the simulation at the start and after a reset.

    Returns:
        Way back -> differences; the results of the first run and of the second run.
    """
    runner = Runner(sim, steps)
    begin(sim)
    start = sim.snapshot()
    before = runner.run(1)
    snapshot = sim.snapshot()
    first = runner.run(2)
    found = {}
    sim.restore(snapshot)
    found["a restore"] = differences(first, runner.run(2))
    with suppress(simkit.errors.SimkitError):
        sim.spawn(_BOX)
    sim.step(7)
    sim.restore(snapshot)
    found["a restore from a world with a newcomer"] = differences(first, runner.run(2))
    sim.restore(start)
    found["a restore of the start"] = differences(before, runner.run(1))
    sim.reset()
    begin(sim)
    found["a reset"] = differences(before, runner.run(1))
    return {way: what for way, what in found.items() if what}, (before, first)


def differences(one: Seen, other: Seen) -> list[str]:
    """Describe the differences between two results."""
    found = []
    if one.physics != other.physics or one.state != other.state:
        found.append("the physics")
    for mine, yours in zip(one.messages, other.messages, strict=False):
        if mine != yours:
            found.append(f"{mine[1]} at tick {mine[0]}")
            break
    if len(one.messages) != len(other.messages):
        found.append(f"{len(one.messages)} messages became {len(other.messages)}")
    found += [f"the reading of {name}" for name, value in one.readings.items() if other.readings[name] != value]
    found += [name for name, value in one.parameters.items() if other.parameters.get(name) != value]
    for name, memory in one.memory.items():
        for attribute in sorted({*memory, *other.memory[name]}):
            if memory.get(attribute) != other.memory[name].get(attribute):
                found.append(f"{name}.{attribute}")
    return found


def _digest(message: Any) -> int:
    return 0 if message is None else short_hash(msgs.serialize(message))


def _fill(message: Any, random: np.random.Generator) -> Any:
    """Set every number of a message to a small random number."""
    for field in dataclasses.fields(message):
        value = getattr(message, field.name)
        if isinstance(value, bool):
            setattr(message, field.name, bool(random.integers(2)))
        elif isinstance(value, float):
            setattr(message, field.name, float(random.uniform(-0.5, 0.5)))
        elif dataclasses.is_dataclass(value) and field.name not in ("header", "stamp"):
            _fill(value, random)
    return message


def _some(random: np.random.Generator, names: str = "xyz") -> dict[str, float]:
    return {name: float(random.uniform(-0.5, 0.5)) for name in names}


def _trajectory(random: np.random.Generator) -> dict[str, Any]:
    points = [
        {"positions": [float(random.uniform(-0.3, 0.3))], "time_from_start": {"nanosec": 40_000_000 * (k + 1)}}
        for k in range(3)
    ]
    return {"joint_names": ["arm"], "points": points}


def _push(random: np.random.Generator) -> dict[str, Any]:
    return {"entity": {"name": "crate", "type": 2}, "wrench": {"force": _some(random), "torque": _some(random)}}


def _waves(random: np.random.Generator) -> dict[str, Any]:
    """Return parameters of a wave field."""
    values = {"amplitude": random.uniform(0.1, 0.5), "period": random.uniform(1, 3)}
    numbers = [{"name": name, "value": {"type": 3, "double_value": value}} for name, value in values.items()]
    direction = {"type": 8, "double_array_value": random.uniform(0.2, 1, 2).tolist()}
    return {"params": [*numbers, {"name": "direction", "value": direction}]}


def _frame(random: np.random.Generator) -> dict[str, Any]:
    """Return a transform for the topic /tf."""
    transform = {"translation": _some(random), "rotation": {"w": 1.0}}
    return {
        "transforms": [{"header": {"frame_id": "world"}, "child_frame_id": "world_desired", "transform": transform}]
    }


def _packet(random: np.random.Generator) -> dict[str, Any]:
    sender, receiver = random.permutation(["addr1", "addr2"]).tolist()
    return {"src_address": sender, "dst_address": receiver, "data": random.integers(0, 256, 8).tolist()}


_NOT_SENT = ("/light_config", "/material_color", "/land")  # `/land` would end a flight before it begins
_SENT = {
    "trajectory_msgs/msg/JointTrajectory": _trajectory,
    "std_msgs/msg/Float64MultiArray": lambda random: {"data": random.uniform(-0.5, 0.5, 2).tolist()},
    "actuator_msgs/msg/Actuators": lambda random: {
        "velocity": random.uniform(0, 40, 4).tolist(),
        "normalized": random.uniform(0.2, 1, 4).tolist(),
    },
    "mav_msgs/msg/Actuators": lambda random: {"angular_velocities": random.uniform(0, 40, 4).tolist()},
    "std_msgs/msg/Int32": lambda random: {"data": int(random.integers(1, 4))},
    "sensor_msgs/msg/JointState": lambda random: {"name": ["arm"], "effort": [float(random.uniform(-0.5, 0.5))]},
    "ros_gz_interfaces/msg/ParamVec": _waves,
    "ros_gz_interfaces/msg/EntityWrench": _push,
    "ros_gz_interfaces/msg/Dataframe": _packet,
    "ros_gz_interfaces/msg/Entity": lambda _: {"name": "wall", "type": 2},
}
