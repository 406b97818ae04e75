"""Observations of an environment: sources bound to a simulation, with their spaces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box

from simkit.errors import InputError
from simkit.experiments.environments.message_arrays import Array, Bounds, Conversion, conversion_of
from simkit.experiments.environments.specification import (
    NO_MESSAGE,
    Environment,
    Observation,
    ObservationSource,
    Problems,
    invalid,
)
from simkit.msgs.topic_names import absolute_name
from simkit.testing.conditions.binder import bind
from simkit.testing.conditions.parser import parse
from simkit.testing.conditions.syntax_tree import UndecidedValue

_INF = np.inf


class BoundObservation:
    """One observation of an environment.

    Args:
        read: function that returns the values; raises UndecidedValue before the first message.
        bounds: bounds of the values, or a function of the first values that returns them.
        given: observation of the specification, whose bounds come first.

    Attributes:
        space: space of the values; None before the first reading.
    """

    def __init__(self, read: Callable[[], Any], bounds: Bounds | Callable[[], Bounds], given: Observation) -> None:
        self._read, self._bounds, self._given = read, bounds, given
        self.space: Box | None = None
        self._limits: tuple[Array, Array] | None = None

    def value(self) -> Array:
        """Return the present values within the space."""
        found = np.asarray(self._read())
        if self._given.sectors is not None:
            found = _sector_minima(found, self._given.sectors)
        if self.space is None:
            self._make_space(found)
        assert self.space is not None
        values = found.astype(self.space.dtype).reshape(self.space.shape)
        if self._limits is not None:
            np.maximum(values, self._limits[0], out=values)
            np.minimum(values, self._limits[1], out=values)
        return values

    def _make_space(self, first: Array) -> None:
        low, high = self._bounds() if callable(self._bounds) else self._bounds
        low = low if self._given.low is None else self._given.low
        high = high if self._given.high is None else self._given.high
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
        self._sensors: list[Any] = []
        self._is_single = not isinstance(sources, Mapping)
        named: Mapping[str, ObservationSource] = sources if isinstance(sources, Mapping) else {"observation": sources}
        problems = Problems()
        self._bound: dict[str, BoundObservation] = {}
        for name, source in named.items():
            given = source if isinstance(source, Observation) else Observation(source)
            try:
                self._bound[name] = self._bind(given)
            except InputError as error:
                problems.add(error, f"observation {name!r}")
        if not named:
            problems.add(invalid("there is none"), "observation")
        problems.raise_all()

    @property
    def space(self) -> gymnasium.Space[Any]:
        """Space of `read`; known after the first reading."""
        spaces: dict[str, Any] = {name: bound.space for name, bound in self._bound.items()}
        return next(iter(spaces.values())) if self._is_single else gymnasium.spaces.Dict(spaces)

    def take_over_sensors(self) -> None:
        """Sample sensors without a subscriber only for observations, not at their rates."""
        for sensor in self._env.sim.contents.sensors.values():
            is_read = any(publisher.wanted for _, publisher, _ in sensor._publishers)
            is_free = not is_read and (sensor not in self._sensors or self._sync)
            sensor.is_manual = is_free and sensor.timing.latency <= 0.0
        self._env.sim.engine.reschedule()

    def read(self) -> Any:
        """Return the present observation.

        Raises:
            UndecidedValue: a topic has no message yet.
        """
        if self._sync:
            tick, now = self._env.sim.tick, self._env.sim.time_ns
            for sensor in self._sensors:
                newest = sensor._sample
                if newest is None or newest.time_ns != now:
                    sensor.sample(tick)
                    newest = sensor._sample
                if newest is not None and newest.held is not None and newest.time_ns == now:
                    # measured in the present data, whose forward pass the next step needs anyway
                    newest.raw, newest.held = sensor._capture_now(tick), None
        values = {name: bound.value() for name, bound in self._bound.items()}
        return next(iter(values.values())) if self._is_single else values

    # ------------------------------------------------------------------ sources

    def _bind(self, given: Observation) -> BoundObservation:
        source, env = given.source, self._env
        if callable(source):
            return BoundObservation(lambda: source(env), (-_INF, _INF), given)
        if not isinstance(source, str) or not source:
            raise invalid(f"found {source!r}; expected a topic, a scoped name, an expression or a function")
        tables = env.sim.contents.handles.tables
        if source in tables["sensor"]:
            return self._sensor(tables["sensor"][source], given)
        if source in tables["joint"]:
            return _joint(tables["joint"][source], given)
        for kind in ("model", "link"):
            if source in tables[kind]:
                return _entity(tables[kind][source], given)
        if source.startswith("/") and " " not in source:
            return self._topic(absolute_name(source), given)
        return self._expression(source, given)

    def _sensor(self, sensor: Any, given: Observation) -> BoundObservation:
        if sensor.timing.latency <= 0.0:  # a delayed reading is old by nature
            self._sensors.append(sensor)
        return _message_observation(lambda: sensor.truth if given.truth else sensor.latest, sensor.scoped, given)

    def _topic(self, topic: str, given: Observation) -> BoundObservation:
        sim = self._env.sim
        for sensor in sim.contents.sensors.values():
            if sensor.topic == topic:
                return self._sensor(sensor, given)
        if given.truth:
            raise invalid(f"truth=True needs the topic of a sensor, but no sensor publishes {topic} first")
        for sensor in sim.contents.sensors.values():
            if topic in sensor._topics.values() and sensor.timing.latency <= 0.0:
                self._sensors.append(sensor)
        self._env.view.topic(topic, topic, parse(f"'{topic}'").root.span)
        feed = self._env.view.latest_message(topic)
        return _message_observation(feed.latest, topic, given)

    def _expression(self, source: str, given: Observation) -> BoundObservation:
        view = self._env.view
        part = bind(parse(self._env.with_variables(source)), view)
        if part.kind.message:
            return _message_observation(part.get, source, given)
        topics = set(view._latest_messages)
        self._sensors += [
            sensor
            for sensor in self._env.sim.contents.sensors.values()
            if topics & set(sensor._topics.values()) and sensor not in self._sensors and sensor.timing.latency <= 0.0
        ]
        return BoundObservation(lambda: _plain_numbers(part.get(), source), (-_INF, _INF), given)


_POSE_BOUNDS: Bounds = (np.array([-_INF] * 3 + [-1.0] * 4), np.array([_INF] * 3 + [1.0] * 4))


def _sector_minima(values: Array, count: int) -> Array:
    """Return the smallest value of each of `count` groups of neighbouring values."""
    if not (values.ndim == 1 and isinstance(count, int) and 1 <= count <= len(values)):
        raise invalid(f"sectors: found {count!r}; expected a whole number from 1 to {len(values)}")
    minima: Array = np.minimum.reduceat(values, np.arange(count) * len(values) // count)
    return minima


def _pose_numbers(pose: Any) -> Array:
    return np.concatenate((pose.position, pose.quaternion))


def _entity(entity: Any, given: Observation) -> BoundObservation:
    """Return the pose of a model or link: position, then quaternion."""
    return BoundObservation(lambda: _pose_numbers(entity.pose), _POSE_BOUNDS, given)


def _plain_numbers(value: Any, source: str) -> Any:
    if hasattr(value, "quaternion"):
        return _pose_numbers(value)
    if isinstance(value, str):
        raise invalid(f"the value of {source} is the text {value!r}; expected numbers")
    return value


def _joint(joint: Any, given: Observation) -> BoundObservation:
    """Return the position and velocity of a joint, between its limits."""

    def read() -> Array:
        return np.concatenate((np.atleast_1d(joint.position), np.atleast_1d(joint.velocity)))

    def bounds() -> Bounds:
        if joint.dof != 1:
            return -_INF, _INF
        # a joint may exceed its limits a little, and its velocity limit is not a limit of the physics
        return np.array([joint.lower, -_INF]), np.array([joint.upper, _INF])

    return BoundObservation(read, bounds, given)


def _message_observation(latest: Callable[[], Any], name: str, given: Observation) -> BoundObservation:
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

    return BoundObservation(read, lambda: limits, given)


def no_message(reason: UndecidedValue, waited: float) -> InputError:
    """Return the error about an observation that has no value after the longest wait [s]."""
    hint = "observe a sensor or a pose, or publish the topic in on_reset"
    return invalid(f"no first observation within {waited:g} s of simulated time: {reason}", hint, NO_MESSAGE)
