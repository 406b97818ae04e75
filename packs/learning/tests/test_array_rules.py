"""Array rules: a sensor and a drive of this file take part in a batch, and expressions have the bits of one world."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Sequence
from typing import Any

import mujoco
import numpy as np
import pytest
from sweep_worlds import CART, SLIDE

import simkit
from simkit import Params
from simkit.extend import NoiseModel
from simkit.runtime.array_rules import Floats, Ids, PluginRule, PresentNumbers, SetCommand, Ticks, TopicRule
from simkit.runtime.state_arrays import StateArrays
from simkit.sensors import sensor_kinds
from simkit.sensors.vector_sensor import VectorRule, VectorSensor
from simkit.testing.conditions.binder import bind
from simkit.testing.conditions.parser import parse

gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")

import simkit.gym  # noqa: E402
from simkit import RunSpec, msgs  # noqa: E402

FLOAT = "std_msgs/msg/Float64"


class Way(VectorSensor):
    """Sensor of the distance from the origin of the world [m]."""

    kinds = ("way",)
    product, message_type = "way", FLOAT

    def prepare(self) -> None:
        self.noise = self._make_noise((NoiseModel(stddev=0.1, bias_mean=0.5, bias_stddev=0.2, precision=0.01),), "way")

    def distances(self, positions: Floats) -> Floats:
        return np.sqrt(np.square(positions[:, self._body]).sum(axis=1))[:, None]

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Floats:
        return self.distances(data.xpos[None])[0]

    def array_rule(self) -> VectorRule:
        return VectorRule(self, ("xpos",), self.distances)

    def _message_of(self, reading: Floats, time_ns: int) -> object:
        return msgs.make(FLOAT, data=float(reading[0]))


class OtherWay(Way):
    """Sensor that may do more than its base class."""

    kinds = ("other_way",)


def half_way(speed: Any, target: Any) -> Any:
    """Return the speed after a step, a number or an array."""
    return speed + 0.5 * (target - speed)


class Winch(simkit.ModelPlugin):
    """Drive that pulls the car with a speed from `/winch`, and publishes this speed on `/pull`."""

    drives = True

    def prepare(self, scene: Any, params: Params, builder: Any) -> None:
        self.servo = builder.add_velocity_servo(SLIDE, max_effort=8.0, owner="winch")

    def load(self, parent: Any, params: Params) -> None:
        self.speed = self.target = 0.0
        self.listen("/winch", "geometry_msgs/msg/Twist", self.on_twist)
        self.pull = self.advertise("/pull", FLOAT)

    def on_twist(self, message: Any) -> None:
        self.target = float(message.linear.x)

    def before_step(self) -> None:
        self.speed = half_way(self.speed, self.target)
        self.sim.engine.set_control(self.servo, self.speed)

    def after_step(self) -> None:
        self.pull.publish(msgs.make(FLOAT, data=self.speed))

    def array_rule(self) -> WinchRule:
        return WinchRule(self)


class WinchRule(PluginRule):
    """The drive in n simulations."""

    def __init__(self, winch: Winch) -> None:
        self.winch = winch

    def bind(self, states: StateArrays) -> None:
        self.servos = states.servos
        self.columns = np.array([states.servos.column(states.sim.engine.names.actuator(self.winch.servo))])
        self.speed, self.target = np.zeros(states.count), np.zeros(states.count)

    def take(self, row: int, tick: int) -> None:
        self.speed[row], self.target[row] = self.winch.speed, self.winch.target

    def command(self, topic: str, fields: Sequence[str]) -> SetCommand | None:
        def set_command(ids: Ids, numbers: Floats) -> None:
            self.target[ids] = numbers[:, fields.index("linear.x")]

        return set_command if topic == "/winch" else None

    def next_stop(self, ids: Ids, tick: int) -> int:
        return tick + 1

    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        self.speed[ids] = half_way(self.speed[ids], self.target[ids])
        self.servos.command(ids, self.columns, self.speed[ids, None], np.ones((len(ids), 1), np.bool_))

    def reading(self, topic: str) -> TopicRule | None:
        return PresentNumbers(None, lambda ids, _: self.speed[ids, None]) if topic == "/pull" else None


@pytest.fixture
def new_kinds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Add the sensors of this file to the known kinds."""
    kinds = ChainMap({"way": Way, "other_way": OtherWay}, dict(sensor_kinds()))
    for module in ("build", "plugins.discovery.make_instances", "sensors.default_parameters"):
        monkeypatch.setattr(f"simkit.{module}.sensor_kinds", lambda: kinds)


SENSOR = '<sensor name="way" type="{}"><update_rate>20</update_rate><topic>way</topic></sensor></link>'
LINK = "</sensor>\n  </link>"


def with_sensor(kind: str) -> str:
    assert CART.count(LINK) == 1
    return CART.replace(LINK, "</sensor>" + SENSOR.format(kind))


def assert_same_bits(make: Callable[[], Any], steps: int = 12, count: int = 3, **options: Any) -> None:
    """Compare all bits of a batch with single environments, each with a new world from a function."""
    options = {"control_period": 0.05, "time_limit": 0.3, **options}
    batch = simkit.gym.make_vec(make(), num_envs=count, batch=True, **options)
    singles = [simkit.gym.make_vec(make(), num_envs=1, processes=False, **options) for _ in range(count)]
    random = np.random.default_rng(5)
    found = batch.reset(seed=11)[0]
    expected = [single.reset(seed=11 + row)[0] for row, single in enumerate(singles)]
    for _ in range(steps):
        for row, observation in enumerate(expected):
            for name, values in observation.items():
                assert found[name][row].tobytes() == values[0].tobytes(), (row, name)
            data = singles[row].envs[0].unwrapped.sim.mj_data
            for state in ("qpos", "qvel", "ctrl"):
                assert getattr(batch.view, state)[row].tobytes() == getattr(data, state).tobytes(), (row, state)
        actions = random.uniform(-1.0, 1.0, (count, 1))
        found = batch.step(actions)[0]
        expected = [single.step(actions[row : row + 1])[0] for row, single in enumerate(singles)]
    for envs in (batch, *singles):
        envs.close()


def test_a_sensor_with_an_array_rule_is_part_of_a_batch(new_kinds: None) -> None:
    observation = {"way": "/way", "truth": simkit.gym.Observation("/way", truth=True), "eye": "/eye"}
    assert_same_bits(lambda: with_sensor("way"), observation=observation, action=SLIDE)


def test_a_drive_with_an_array_rule_is_part_of_a_batch() -> None:
    observation = {"pull": "/pull", "slide": SLIDE, "eye": "/eye"}

    def world() -> RunSpec:
        return RunSpec(CART, name="w", plugins=(("cart", Winch()),))

    assert_same_bits(world, observation=observation, action={"/winch": {"linear.x": (-1.0, 1.0)}})


def test_an_inherited_rule_does_not_count(new_kinds: None) -> None:
    with pytest.raises(simkit.errors.InputError, match=r"SK-GYM-001.*sensor 'cart::car::way' \(other_way\)"):
        simkit.gym.make_vec(with_sensor("other_way"), num_envs=2, batch=True, observation="/way", action=SLIDE)


@pytest.mark.parametrize(
    "source",
    [
        f"joint('{SLIDE}').position / joint('{SLIDE}').velocity + 2 % 0.3 - log(time) ** 2",
        "atan2(pose('cart::car').x, 0.1) + round(100 * pose('cart::car').x) + wrap(5 * time)",
        "norm(3 * (pose('cart::car').position - (1, 2, 3))) + distance('cart::car', (0, 1, 0))",
        "min(velocity('cart::car').x, 0.1, exp(-time)) + max(pose('cart::car').position) + pose('cart::car').roll",
        "clamp(sqrt(abs(pose('cart::car').x)), 0, 0.2) + mean(pose('cart::car').position) + twist('cart').angular.z",
    ],
)
def test_expressions_have_the_bits_of_one_world(source: str) -> None:
    """The value of each environment is that of the expression in a simulation with the same steps."""
    observation = {"slide": SLIDE}
    values = []
    for batch in (True, False):
        more = {"batch": True} if batch else {"processes": False}
        envs = simkit.gym.make_vec(CART, num_envs=1, observation=observation, action=SLIDE, reward=source, **more)
        envs.reset(seed=3)
        values.append([float(envs.step(np.array([[force]]))[1][0]) for force in (4.0, -8.0, 0.0, 2.5)])
        envs.close()
    assert values[0] == values[1]


def test_a_value_of_one_world_is_a_number_and_of_many_an_array() -> None:
    with simkit.load(CART) as sim:
        sim.step(10)
        view = simkit.testing.conditions.world_view.WorldView(sim)
        assert isinstance(bind(parse("pose('cart::car').x + 1"), view).get(), float)
