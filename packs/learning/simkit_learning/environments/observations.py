"""Observations of an environment: sources bound to a simulation, with their spaces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.spaces import Box

from simkit import Joint, Link, Model, Pose
from simkit.errors import InputError
from simkit.extend import Sensor
from simkit.msgs import Message, absolute_name
from simkit.testing.conditions.binder import bind
from simkit.testing.conditions.parser import parse
from simkit.testing.conditions.syntax_tree import UndecidedValue
from simkit_learning.environments.message_arrays import Array, Bounds, Conversion, conversion_of
from simkit_learning.environments.specification import (
    NO_MESSAGE,
    Environment,
    Observation,
    ObservationSource,
    Problems,
    invalid,
)

_INF = np.inf


class BoundObservation:
    """One observation of an environment.

    Args:
        read: function that returns the values; raises UndecidedValue before the first message.
        bounds: bounds of the values, or a function of the first values that returns them.
        observation: observation of the specification, whose bounds come first.

    Attributes:
        space: space of the values; None before the first reading.
    """

    def __init__(
        self, read: Callable[[], npt.ArrayLike], bounds: Bounds | Callable[[], Bounds], observation: Observation
    ) -> None:
        self._read, self._bounds, self._observation = read, bounds, observation
        self.space: Box | None = None
        self._limits: tuple[Array, Array] | None = None

    def value(self) -> Array:
        """Return the present values within the space."""
        read = np.asarray(self._read())
        if self.space is None:
            self._make_space(_sector_minima(read, self._observation.sectors))
        return self.values_in_space(read)

    def present_source(self) -> Array:
        """Return the present values of the source, before they are limited to the space."""
        return np.asarray(self._read())

    def values_in_space(self, read: Array, count: int | None = None) -> Array:
        """Return values of the source within the space, shape of the space.

        Args:
            read: values of the source; with `count`, an array with those of each of several environments.
            count: number of environments; None for one, without an axis for them.
        """
        assert self.space is not None
        sectors, rows = self._observation.sectors, () if count is None else (count,)
        if sectors is not None:
            read = _sector_minima(read, sectors, len(rows))
        values = read.astype(self.space.dtype).reshape(*rows, *self.space.shape)
        if self._limits is not None:
            np.maximum(values, self._limits[0], out=values)
            np.minimum(values, self._limits[1], out=values)
        return values

    def _make_space(self, first: Array) -> None:
        low, high = self._bounds() if callable(self._bounds) else self._bounds
        low = low if self._observation.low is None else self._observation.low
        high = high if self._observation.high is None else self._observation.high
        shape = first.shape or (1,)
        dtype = np.uint8 if first.dtype == np.uint8 else np.float32
        try:
            ends = [np.broadcast_to(np.asarray(end, dtype), shape) for end in (low, high)]
        except (TypeError, ValueError):
            raise invalid(f"bounds {low!r} and {high!r} do not fit values of the shape {shape}") from None
        if not np.all(ends[0] <= ends[1]):
            raise invalid(f"the lower bound {low!r} is above the upper bound {high!r}")
        self.space = Box(ends[0], ends[1], shape, dtype)
        if dtype == np.float32 and np.isfinite(ends).any():
            self._limits = ends[0], ends[1]


class Observations:
    """All observations of an environment, bound to its simulation.

    Args:
        env: environment.
        sources: one source, or sources by name.
        sync: take a sample of each observed sensor at the time of an observation.

    Raises:
        InputError: sources have errors; the message lists all of them.
    """

    def __init__(
        self, env: Environment, sources: ObservationSource | Mapping[str, ObservationSource], sync: bool
    ) -> None:
        self._env, self._sync = env, sync
        self._sensors: list[Sensor] = []
        self._is_single = not isinstance(sources, Mapping)
        named: Mapping[str, ObservationSource] = sources if isinstance(sources, Mapping) else {"observation": sources}
        problems = Problems()
        self._bound: dict[str, BoundObservation] = {}
        for name, source in named.items():
            observation = source if isinstance(source, Observation) else Observation(source)
            try:
                self._bound[name] = self._bind(observation)
            except InputError as error:
                problems.add(error, f"observation {name!r}")
        if not named:
            problems.add(invalid("there is none"), "observation")
        problems.raise_all()

    @property
    def space(self) -> gymnasium.Space[Any]:
        """Space of `read`; known after the first reading."""
        bound = {name: observation.space for name, observation in self._bound.items()}
        spaces: dict[str, gymnasium.Space[Any]] = {name: space for name, space in bound.items() if space is not None}
        return next(iter(spaces.values())) if self._is_single else gymnasium.spaces.Dict(spaces)

    def take_over_sensors(self) -> None:
        """Sample sensors without a subscriber only for observations, not at their rates."""
        for sensor in self._env.sim.contents.sensors.values():
            is_free = not sensor.has_subscriber and (sensor not in self._sensors or self._sync)
            sensor.is_manual = is_free and sensor.timing.latency <= 0.0 and sensor.lasting is None
        self._env.sim.engine.reschedule()

    def read(self) -> Array | dict[str, Array]:
        """Return the present observation.

        Raises:
            UndecidedValue: a topic has no message yet.
        """
        if self._sync:
            for sensor in self._sensors:
                sensor.sample_now(self._env.sim.tick)
        values = {name: bound.value() for name, bound in self._bound.items()}
        return next(iter(values.values())) if self._is_single else values

    def source_of(self, name: str) -> BoundObservation:
        """Return a named observation."""
        return self._bound[name]

    # ------------------------------------------------------------------ sources

    def _bind(self, observation: Observation) -> BoundObservation:
        source, env = observation.source, self._env
        if callable(source):
            return BoundObservation(lambda: source(env), (-_INF, _INF), observation)
        if not isinstance(source, str) or not source:
            raise invalid(f"found {source!r}; expected a topic, a scoped name, an expression or a function")
        tables = env.sim.contents.handles.tables
        if source in tables["sensor"]:
            return self._sensor(tables["sensor"][source], observation)
        if source in tables["joint"]:
            return _joint(tables["joint"][source], observation)
        for kind in ("model", "link"):
            if source in tables[kind]:
                return _entity(tables[kind][source], observation)
        if source.startswith("/") and " " not in source:
            return self._topic(absolute_name(source), observation)
        return self._expression(source, observation)

    def _sensor(self, sensor: Sensor, observation: Observation) -> BoundObservation:
        if sensor.timing.latency <= 0.0:  # a delayed reading is old by nature
            self._sensors.append(sensor)
        return _message_observation(
            lambda: sensor.truth if observation.truth else sensor.latest, sensor.scoped, observation
        )

    def _topic(self, topic: str, observation: Observation) -> BoundObservation:
        sim = self._env.sim
        for sensor in sim.contents.sensors.values():
            if sensor.topic == topic:
                return self._sensor(sensor, observation)
        if observation.truth:
            raise invalid(f"truth=True needs the topic of a sensor, but no sensor publishes {topic} first")
        for sensor in sim.contents.sensors.values():
            if topic in sensor.topics.values() and sensor.timing.latency <= 0.0:
                self._sensors.append(sensor)
        self._env.view.topic(topic, topic, parse(f"'{topic}'").root.span)
        feed = self._env.view.latest_message(topic)
        return _message_observation(feed.latest, topic, observation)

    def _expression(self, source: str, observation: Observation) -> BoundObservation:
        view = self._env.view
        part = bind(parse(self._env.with_variables(source)), view)
        if part.kind.message:
            return _message_observation(part.get, source, observation)
        topics = set(view.topics_read)
        self._sensors += [
            sensor
            for sensor in self._env.sim.contents.sensors.values()
            if topics & set(sensor.topics.values()) and sensor not in self._sensors and sensor.timing.latency <= 0.0
        ]
        return BoundObservation(lambda: _plain_numbers(part.get(), source), (-_INF, _INF), observation)


_POSE_BOUNDS: Bounds = (np.array([-_INF] * 3 + [-1.0] * 4), np.array([_INF] * 3 + [1.0] * 4))


def _sector_minima(values: Array, count: int | None, axis: int = 0) -> Array:
    """Return the smallest value of each of `count` groups of neighbouring values on the last axis; None for no groups.

    `axis` is the expected number of this axis.
    """
    if count is None:
        return values
    length = len(values) if values.ndim <= axis else values.shape[axis]
    if not (values.ndim == axis + 1 and isinstance(count, int) and 1 <= count <= length):
        raise invalid(f"sectors: found {count!r}; expected a whole number from 1 to {length}")
    minima: Array = np.minimum.reduceat(values, np.arange(count) * length // count, axis=axis)
    return minima


def _pose_numbers(pose: Pose) -> Array:
    return np.concatenate((pose.position, pose.quaternion))


def _entity(entity: Model | Link, observation: Observation) -> BoundObservation:
    """Return the pose of a model or link: position, then quaternion."""
    return BoundObservation(lambda: _pose_numbers(entity.pose), _POSE_BOUNDS, observation)


def _plain_numbers(value: object, source: str) -> npt.ArrayLike:
    if isinstance(value, Pose):
        return _pose_numbers(value)
    if isinstance(value, str):
        raise invalid(f"the value of {source} is the text {value!r}; expected numbers")
    return cast(npt.ArrayLike, value)


def _joint(joint: Joint, observation: Observation) -> BoundObservation:
    """Return the position and velocity of a joint, between its limits."""

    def read() -> Array:
        return np.concatenate((np.atleast_1d(joint.position), np.atleast_1d(joint.velocity)))

    def bounds() -> Bounds:
        if joint.dof != 1:
            return -_INF, _INF
        # a joint may exceed its limits a little, and its velocity limit is not a limit of the physics
        return np.array([joint.lower, -_INF]), np.array([joint.upper, _INF])

    return BoundObservation(read, bounds, observation)


def _message_observation(latest: Callable[[], Message | None], name: str, observation: Observation) -> BoundObservation:
    """Return the observation of the newest message of a topic or a sensor."""
    conversion: Conversion | None = None
    limits: Bounds = (-_INF, _INF)

    def read() -> Array:
        nonlocal conversion, limits
        message = latest()
        if message is None:
            raise UndecidedValue(f"no message received from {name}")
        if conversion is None:
            conversion, limits = conversion_of(message)
        return conversion(message)

    return BoundObservation(read, lambda: limits, observation)


def no_message(reason: UndecidedValue, waited: float) -> InputError:
    """Return the error about an observation that has no value after the longest wait [s]."""
    hint = "observe a sensor or a pose, or publish the topic in on_reset"
    return invalid(f"no first observation within {waited:g} s of simulated time: {reason}", hint, NO_MESSAGE)
