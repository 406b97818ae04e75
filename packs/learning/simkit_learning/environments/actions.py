"""Actions of an environment: numbers that become messages on topics and efforts of joints."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from gymnasium.spaces import Box

from simkit import msgs
from simkit.diagnostics import shorten
from simkit.errors import InputError
from simkit.extend import did_you_mean
from simkit.msgs import Message, absolute_name
from simkit.msgs.message_builder import builder_of
from simkit_learning.environments.specification import (
    INVALID_ACTION,
    ActionTarget,
    JointVelocities,
    Problems,
    invalid,
)

if TYPE_CHECKING:
    from simkit import Joint, Simulation

Bounds = tuple[float, float]
Send = Callable[[list[float]], None]
"""Function that sends the numbers of one target."""
SetField = Callable[[Message, float], None]
"""Function that sets a field of a message."""

_FIELD: Final = re.compile(r"[a-z_][a-z0-9_]*(\.[a-z_][a-z0-9_]*)*(\[\d{1,4}\])?")
_LEAD: Final = 0.3  # [rad, m] a blocked joint must not store a long way that it makes up for later
_TRAJECTORY: Final = "trajectory_msgs/msg/JointTrajectory"


class Actions:
    """Targets of an environment's actions, bound to its simulation.

    Args:
        sim: simulation.
        targets: one target, or targets with their bounds.
        period: time between two actions [s].
        is_scaled: True for actions from -1 to 1, which stand for the bounds.

    Attributes:
        names: name of each number of an action.
        space: space of the actions.
        integrals: integrals of commanded velocities.

    Raises:
        InputError: SK-GYM-002 targets have errors; the message lists all of them.
    """

    def __init__(
        self, sim: Simulation, targets: str | Mapping[str, ActionTarget], period: float, is_scaled: bool
    ) -> None:
        self.sim, self._period = sim, period
        self._sends: list[tuple[int, Send]] = []
        self._efforts: list[tuple[Joint, float]] = []
        self.integrals: list[_VelocityIntegral] = []
        self._has_joints = False
        self.names: list[str] = []
        bounds: list[Bounds] = []
        problems = Problems()
        for target, details in ({targets: None} if isinstance(targets, str) else targets).items():
            try:
                names, limits, send = self._bind(target, details)
            except InputError as error:
                problems.add(error, f"action {target!r}")
                continue
            self._sends.append((len(names), send))
            self.names += names
            bounds += limits
        if not targets:
            problems.add(_wrong("there is none"), "action")
        problems.raise_all()
        low, high = (np.array(ends) for ends in zip(*bounds, strict=True))
        self._middle, self._half = (high + low) / 2, (high - low) / 2
        self._low: npt.NDArray[np.float64]
        self._high: npt.NDArray[np.float64]
        self._low, self._high = (-np.ones(len(low)), np.ones(len(low))) if is_scaled else (low, high)
        self._is_scaled = is_scaled
        self.space = Box(self._low.astype(np.float32), self._high.astype(np.float32), dtype=np.float32)
        if self._has_joints:
            # an effort acts in one step only, but an action holds for the whole control period
            sim.communication.on_demand.add(lambda: True, None, self._push, "before")

    def send(self, action: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Send an action, limited to its bounds, and return the limited numbers.

        Raises:
            InputError: SK-GYM-004 the action has another shape, or a number is NaN.
        """
        try:
            values = np.asarray(action, dtype=np.float64)
        except (TypeError, ValueError):
            values = np.empty(0)
        if values.shape != self._low.shape or np.isnan(values).any():
            names = ", ".join(self.names)
            text = f"found the action {shorten(repr(action), 60)}; expected the shape {self._low.shape} with {names}"
            raise invalid(text, "limit NaN and other invalid numbers before step", "SK-GYM-004")
        values = self.limited(values)
        numbers: list[float] = self.numbers_of(values).tolist()
        self._efforts.clear()
        start = 0
        for count, send in self._sends:
            send(numbers[start : start + count])
            start += count
        return values

    def limited(self, values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return actions within their bounds, shape (numbers,) or (environments, numbers)."""
        limited: npt.NDArray[np.float64] = np.minimum(np.maximum(values, self._low), self._high)
        return limited

    def numbers_of(self, values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return the numbers that limited actions stand for, in the same shape."""
        return self._middle + self._half * values if self._is_scaled else values

    def clear(self) -> None:
        """Forget the efforts and positions of the last action."""
        self._efforts.clear()
        for integral in self.integrals:
            integral.clear()

    def _push(self, _: int) -> None:
        for joint, effort in self._efforts:
            joint.set_effort(effort)

    # ------------------------------------------------------------------ targets

    def _bind(self, target: str, details: ActionTarget) -> tuple[list[str], list[Bounds], Send]:
        joints = self.sim.contents.handles.tables["joint"]
        if target in joints:
            return self._joint(joints[target], details)
        bus = self.sim.communication.bus
        subscribed = {each.topic: each.type_name for each in bus.subscriptions() if each.type_name}  # inputs of nodes
        topics = {**subscribed, **bus.all_topics()}
        topic = absolute_name(target) if target.startswith("/") else target
        if topic not in topics:
            hint = did_you_mean(topic, [*topics, *joints]) or "simkit inspect and `simkit topic list` show the names"
            raise _wrong("the world has no such topic or joint", hint)
        types = bus.types_of(topic) or [subscribed[topic]]
        if _TRAJECTORY in types:
            return self._trajectory(topic, details)
        return self._message(topic, types[0], details)

    def _joint(self, joint: Joint, details: ActionTarget) -> tuple[list[str], list[Bounds], Send]:
        limit = joint.effort_limit if joint.dof == 1 else math.inf
        if joint.dof != 1:
            raise _wrong(f"the joint has {joint.dof} degrees of freedom; expected one")
        if details is None and not math.isfinite(float(limit)):
            raise _wrong("the joint has no effort limit", "give the bounds of the effort, such as (-1.0, 1.0)")
        bounds = (-float(limit), float(limit)) if details is None else _bounds(details)
        self._has_joints = True
        return [f"{joint.scoped} effort"], [bounds], lambda numbers: self._efforts.append((joint, numbers[0]))

    def _trajectory(self, topic: str, details: ActionTarget) -> tuple[list[str], list[Bounds], Send]:
        """Return the target of a trajectory controller: joint positions to reach at the end of the control period."""
        is_velocity = isinstance(details, JointVelocities)
        listed = details.joints if isinstance(details, JointVelocities) else details
        names = [name for name in listed if isinstance(name, str)] if isinstance(listed, (Mapping, list, tuple)) else []
        if not names or not listed or len(names) != len(listed):
            raise _wrong("a trajectory needs the names of joints", 'write {"' + topic + '": ["arm_1_joint", …]}')
        joints = [self._joint_of_trajectory(name) for name in names]
        limits = []
        for name, joint in zip(names, joints, strict=True):
            if isinstance(details, JointVelocities):
                most = float(joint.velocity_limit) if details.limit is None else details.limit
                limits.append(_bounds((-most, most)))
            elif isinstance(details, Mapping):
                limits.append(_bounds(details[name]))
            else:
                limits.append(_bounds((float(joint.lower), float(joint.upper))))
        publisher = self.sim.advertise(topic, _TRAJECTORY)
        time_from_start = msgs.duration(round(self._period * 1e9))
        point = msgs.type_of("trajectory_msgs/msg/JointTrajectoryPoint")
        make, nothing = builder_of(_TRAJECTORY).default, np.empty(0)
        follower = _VelocityIntegral(joints, self._period)
        if is_velocity:
            self.integrals.append(follower)

        def send(numbers: list[float]) -> None:
            message = make()
            message.joint_names = names
            positions = follower.positions(numbers) if is_velocity else np.array(numbers)
            message.points = [point(positions, nothing, nothing, nothing, time_from_start)]
            publisher.publish(message)

        return names, limits, send

    def _joint_of_trajectory(self, name: str) -> Joint:
        joints = self.sim.contents.handles.tables["joint"]
        named = [joint for scoped, joint in joints.items() if scoped.rpartition("::")[2] == name]
        if not named:
            raise _wrong(
                f"the world has no joint {name!r}", did_you_mean(name, [n.rpartition("::")[2] for n in joints])
            )
        joint: Joint = named[0]
        return joint

    def _message(self, topic: str, type_name: str, details: ActionTarget) -> tuple[list[str], list[Bounds], Send]:
        if not isinstance(details, Mapping):
            field = (_number_fields(builder_of(type_name).default()) or ["data[0]"])[0]
            hint = 'write {"' + topic + '": {"' + field + '": (-1.0, 1.0)}}'
            raise _wrong(f"a {type_name} needs the bounds of its fields", hint)
        make = builder_of(type_name).default
        setters: list[SetField] = []
        lengths: dict[str, int] = {}
        sample = make()
        for path in details:
            setter, array, index = _setter(sample, str(path), type_name)
            setters.append(setter)
            if array:
                lengths[array] = max(lengths.get(array, 0), index + 1)
        publisher = self.sim.advertise(topic, type_name)

        def send(numbers: list[float]) -> None:
            message = make()
            for array, length in lengths.items():
                owner, name = _owner(message, array)
                setattr(owner, name, np.zeros(length, getattr(owner, name).dtype))
            for setter, number in zip(setters, numbers, strict=True):
                setter(message, number)
            publisher.publish(message)

        return [f"{topic} {path}" for path in details], [_bounds(details[path]) for path in details], send


class _VelocityIntegral:
    """Integral of the velocities of joints, from their positions at the first action.

    Args:
        joints: joints with one degree of freedom.
        period: time between two actions [s].

    Attributes:
        wanted: positions at the end of the last control period; None before the first action.
    """

    def __init__(self, joints: list[Joint], period: float) -> None:
        self._joints, self._period = joints, period
        self.wanted: npt.NDArray[np.float64] | None = None

    def clear(self) -> None:
        """Begin at the present positions again."""
        self.wanted = None

    def positions(self, velocities: list[float]) -> npt.NDArray[np.float64]:
        """Return the positions at the end of the control period, at most `_LEAD` before the present ones."""
        present = np.array([float(joint.position) for joint in self._joints])
        if self.wanted is None:
            self.wanted = present
        low = np.array([float(joint.lower) for joint in self._joints])
        high = np.array([float(joint.upper) for joint in self._joints])
        wanted = self.wanted + self._period * np.array(velocities)
        self.wanted = np.clip(np.clip(wanted, present - _LEAD, present + _LEAD), low, high)
        return self.wanted


def _wrong(message: str, hint: str = "") -> InputError:
    return invalid(message, hint, INVALID_ACTION)


def _bounds(value: object) -> Bounds:
    listed = value if isinstance(value, (tuple, list)) else ()
    numbers = [float(bound) for bound in listed if isinstance(bound, (int, float)) and math.isfinite(bound)]
    if len(listed) != 2 or len(numbers) != 2 or not numbers[0] < numbers[1]:
        raise _wrong(f"found {value!r}; expected two finite numbers, the lower bound first")
    return numbers[0], numbers[1]


def _owner(message: Message, path: str) -> tuple[Message, str]:
    """Return the message that has the last field of a path, and the name of this field."""
    *parents, name = path.split(".")
    for parent in parents:
        message = getattr(message, parent)
    return message, name


def _number_fields(message: Message, before: str = "") -> list[str]:
    """Return the paths of the numbers of a message; arrays of numbers have the index 0."""
    paths: list[str] = []
    for field in fields(message):
        value, path = getattr(message, field.name), before + field.name
        if field.name in ("header", "stamp"):
            continue
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            paths.append(path)
        elif isinstance(value, np.ndarray):
            paths.append(f"{path}[0]")
        elif is_dataclass(value):
            paths += _number_fields(value, path + ".")
    return paths


def _setter(sample: Message, path: str, type_name: str) -> tuple[SetField, str, int]:
    """Return the function that sets a field, and the path and the index of an array's item."""
    if not _FIELD.fullmatch(path):
        raise _wrong(f"found the field {path!r}; expected a path such as linear.x or data[0]")
    plain, _, item = path.partition("[")
    try:
        owner, name = _owner(sample, plain)
        value = getattr(owner, name)
    except AttributeError:
        known = _number_fields(sample)
        hint = did_you_mean(plain, [field.partition("[")[0] for field in known]) or f"available: {', '.join(known)}"
        raise _wrong(f"a {type_name} has no field {plain!r}", hint) from None
    if item:
        if not isinstance(value, np.ndarray):
            raise _wrong(f"the field {plain!r} of a {type_name} is no list of numbers")
        index = int(item[:-1])

        def set_item(message: Message, number: float) -> None:
            owner, name = _owner(message, plain)
            getattr(owner, name)[index] = number

        return set_item, plain, index
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        hint = f"available: {', '.join(_number_fields(sample))}"
        raise _wrong(f"the field {path!r} of a {type_name} is no number", hint)
    convert, parents = type(value), plain.rpartition(".")[0]
    find_owner = attrgetter(parents) if parents else None

    def set_field(message: Message, number: float) -> None:
        setattr(message if find_owner is None else find_owner(message), name, convert(number))

    return set_field, "", 0
