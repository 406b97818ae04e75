"""Observations and actions of a batch, and the reasons why a world cannot be stepped as a batch."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Simulation
from simkit.extend import Sensor
from simkit.msgs import absolute_name
from simkit.packs import is_shipped
from simkit.runtime.array_rules import CannotBatchError, PluginRule, SetCommand, array_rule_of
from simkit.sensors.base import sensor_rule
from simkit_learning.environments.array_view import ArrayView
from simkit_learning.environments.expression_arrays import array_expression
from simkit_learning.environments.message_arrays import Array
from simkit_learning.environments.observations import BoundObservation
from simkit_learning.environments.sampled_rows import SampledRows, SampledSensor
from simkit_learning.environments.specification import ActionTarget, Batched, Observation

if TYPE_CHECKING:
    from simkit_learning.environments.environment import SimulationEnv
    from simkit_learning.environments.specification import EnvironmentSpec, Value

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.intp]
Read = Callable[[Ids], npt.ArrayLike]

_HOOKS: Final = ("before_step", "after_step")


# ---------------------------------------------------------------------- the world


def world_obstacles(sim: Simulation) -> list[str]:
    """Return why the steps of a world cannot be made in one call for all environments; empty if they can."""
    physics, obstacles = sim.engine.physics, []
    if physics.law.is_on or physics.fast_bodies.can_be_fast or physics.free_motion is not None:
        obstacles.append(
            "simkit's contact law needs Python at each step; overrides=['physics.contact_law=mujoco'] selects MuJoCo's"
        )
    if sim.nodes:
        obstacles.append("nodes")
    if physics.shaper is not None:
        obstacles.append("contacts with directional friction, slip or a moving surface")
    if physics.sleep.watches or physics.sleep.counts:
        obstacles.append("bodies that may sleep")
    if physics.persistent_wrenches.any():
        obstacles.append("persistent wrenches")
    return [*obstacles, *plugin_rules(sim)[1]]


def plugin_rules(sim: Simulation) -> tuple[list[PluginRule], list[str]]:
    """Return the array rules of the plugins of a world, and why other plugins cannot be part of a batch."""
    rules, obstacles = [], []
    for plugin in sim.engine.structure.all_plugins():
        try:
            rule = array_rule_of(plugin, PluginRule)  # type: ignore[type-abstract]
        except CannotBatchError as error:
            obstacles.append(str(error))
            continue
        if rule is not None:
            rules.append(rule)
        elif not vars(type(plugin)).get("only_publishes", False):
            acts = (
                any(map(plugin.has_hook, _HOOKS))
                or hasattr(plugin, "move_scenery")
                or getattr(plugin, "is_gz_system", False)
            )
            if acts or not is_shipped(type(plugin)):
                obstacles.append(f"plugin {type(plugin).__name__}")
    return rules, obstacles


def spec_obstacles(spec: EnvironmentSpec, render_mode: str | None) -> list[str]:
    """Return which options of an environment need separate environments; empty if none does."""
    obstacles = []
    if render_mode is not None:
        obstacles.append("render_mode")
    if not spec.sync:
        obstacles.append("sync=False")
    return obstacles


# ---------------------------------------------------------------------- values of functions


def array_value(value: Value | None, view: ArrayView, name: str, env: SimulationEnv) -> Callable[[], npt.ArrayLike]:
    """Return the function that returns a reward or an end of all environments."""
    if isinstance(value, str):
        try:
            get = _expression(value, view, env)
        except CannotBatchError as error:
            raise CannotBatchError(f"{name}: {error}") from None
        return lambda: np.broadcast_to(get(), (view.count,))
    if isinstance(value, Batched):
        return lambda: value.of_all(view)
    if isinstance(value, (bool, int, float)) or value is None:
        return lambda: np.full(view.count, value or 0.0)
    raise CannotBatchError(f"{name} is a Python function of one environment; simkit.gym.Batched has one for arrays")


def _expression(source: str, view: ArrayView, env: SimulationEnv) -> Callable[[], Array]:
    if env.with_variables(source) != source:
        raise CannotBatchError(f"the expression {source!r} has variables, whose values differ")
    return array_expression(source, view, env.view)


# ---------------------------------------------------------------------- observations


class ObservationArrays:
    """One observation of all environments.

    Args:
        bound: observation of the environment that resets all others.
        read: function that returns the values before they are limited to the space.
    """

    def __init__(self, bound: BoundObservation, read: Read) -> None:
        self._bound, self._read = bound, read

    def values(self, ids: Ids) -> Array:
        """Return the present values of all environments within the space."""
        read = np.asarray(self._read(ids))
        with np.errstate(invalid="ignore"):
            return self._bound.values_in_space(read, len(read))


class Sources:
    """Sources of observations as arrays.

    Attributes:
        sensors: sensors with their samples.
        sampled: messages that plugins publish at their own rates.
    """

    def __init__(self, env: SimulationEnv, view: ArrayView, rules: Sequence[PluginRule]) -> None:
        self._env, self._view, self._rules = env, view, rules
        self.sensors: list[SampledSensor] = []
        self.sampled: list[SampledRows] = []

    @property
    def needs_acceleration(self) -> bool:
        """True if a source reads accelerations."""
        return any(sensor.needs_acceleration for sensor in self.sensors)

    def bind(self, observation: Observation, name: str) -> Read:
        """Return the function that reads the source of a named observation in all environments.

        Raises:
            CannotBatchError: the source needs Python for each environment.
        """
        source, view, sim = observation.source, self._view, self._env.sim
        if isinstance(source, Batched):
            return lambda _: source.of_all(view)
        if not isinstance(source, str):
            raise CannotBatchError("a Python function of one environment; simkit.gym.Batched has one for arrays")
        tables = sim.contents.handles.tables
        if source in tables["sensor"]:
            return self._sensor(tables["sensor"][source], observation)
        if source in tables["joint"]:
            joint = tables["joint"][source]
            if joint.dof != 1:
                raise CannotBatchError(f"joint {source!r} has {joint.dof} degrees of freedom")
            return lambda _: np.stack((view.joint_position(source), view.joint_velocity(source)), axis=1)
        if source in tables["model"] or source in tables["link"]:
            return self._pose(source)
        if source.startswith("/") and " " not in source:
            return self._topic(absolute_name(source), observation, name)
        get = _expression(source, view, self._env)
        return lambda _: np.broadcast_to(value := np.asarray(get()), (view.count, *value.shape[1:]))

    def _pose(self, name: str) -> Read:
        view = self._view
        try:
            view.place(name)
        except KeyError:
            raise CannotBatchError(f"the pose of the static model {name!r}") from None
        return lambda _: np.hstack((view.position(name), view.quaternion(name)))

    def _sensor(self, sensor: Sensor, observation: Observation) -> Read:
        sampled = SampledSensor(sensor, sensor_rule(sensor), self._view, observation.truth)
        self.sensors.append(sampled)
        return sampled.read

    def _topic(self, topic: str, observation: Observation, name: str) -> Read:
        for sensor in self._env.sim.contents.sensors.values():
            if sensor.topic == topic:
                return self._sensor(sensor, observation)

        def observed() -> Array:
            return self._env.observations.source_of(name).present_source()  # each reset binds the observations again

        for rule in self._rules:
            message = rule.reading(topic)
            if message is not None:
                rows = SampledRows(message, observed, self._view.count)
                self.sampled.append(rows)
                return lambda _: rows.values
        raise CannotBatchError(f"topic {topic}")


# ---------------------------------------------------------------------- actions


class ActionArrays:
    """Actions of all environments.

    Args:
        env: environment that resets all others.
        view: state of all environments.
        applied: forces on degrees of freedom, one row for each environment.
        rules: array rules of the plugins.
    """

    def __init__(self, env: SimulationEnv, view: ArrayView, applied: Floats, rules: Sequence[PluginRule]) -> None:
        self._applied, self._view = applied, view
        self._commands: list[tuple[slice, SetCommand]] = []
        self._efforts: list[tuple[int, int, float]] = []
        action = env.spec_of_env.action
        targets: Mapping[str, ActionTarget] = {action: None} if isinstance(action, str) else action
        first = 0
        for target, details in targets.items():
            joint = env.sim.contents.handles.tables["joint"].get(target)
            if joint is not None:
                self._efforts.append((first, joint.mj_dofs[0], float(joint.effort_limit)))
                first += 1
            else:
                first += self._bind_topic(target, details, rules, first)

    def _bind_topic(self, target: str, details: ActionTarget, rules: Sequence[PluginRule], first: int) -> int:
        """Bind the fields of a topic, and return their number."""
        topic = absolute_name(target)
        # a stamped message has its fields in a message with the name of its type
        fields = [str(path).removeprefix("twist.") for path in details] if isinstance(details, Mapping) else []
        possible = [rule.command(topic, fields) for rule in rules if fields]
        commands = [command for command in possible if command is not None]
        if not commands:
            raise CannotBatchError(f"action {target!r}: only twists of differential drives and efforts of joints")
        self._commands += [(slice(first, first + len(fields)), command) for command in commands]
        return len(fields)

    def send(self, ids: Ids, numbers: Floats) -> None:
        """Send the actions of some environments, which act until the next call."""
        for columns, command in self._commands:
            command(ids, numbers[:, columns])
        for column, dof, limit in self._efforts:
            self._applied[ids, dof] = np.clip(numbers[:, column], -limit, limit)
