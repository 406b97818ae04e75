"""Does again what a journal says: the same things through the same doors, between the same two steps."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from simkit.errors import InputError, MessageError, SimkitError
from simkit.msgs import Message
from simkit.pose import Pose
from simkit.run_spec import JsonMapping
from simkit.testing.bundles.direct_changes import apply_changes
from simkit.testing.bundles.journal_values import decode_message, decode_value

if TYPE_CHECKING:
    from simkit.runtime import Publisher, Simulation, Snapshot
    from simkit.runtime.communication.action_server import GoalHandle

Entry = JsonMapping


class JournalPlayer:
    """Plays a journal into a simulation.

    Args:
        sim: at t = 0.
        entries: of the journal, in order.

    Attributes:
        count: how many entries were played.
        refused: what could not be done, in words: it was refused in the run too, or the worlds differ.
    """

    def __init__(self, sim: Simulation, entries: Iterable[Entry]) -> None:
        self._sim = sim
        self._between: deque[Entry] = deque()
        self._within: dict[int, deque[Entry]] = defaultdict(deque)
        self._restored: set[object] = set()
        self._cancelled: set[object] = set()
        for entry in entries:
            place = entry.get("in")
            if place is None:
                self._between.append(entry)
            else:
                self._within[_whole_number(place[0])].append(entry)
            if entry["do"] == "restore":
                self._restored.add(entry.get("number"))
            if entry["do"] == "cancel":
                self._cancelled.add(entry.get("goal"))
        self._snapshots: dict[object, Snapshot] = {}
        self._goals: dict[object, GoalHandle] = {}
        self._publishers: dict[object, Publisher] = {}
        self._deeds = self._entry_deeds()
        self.count = 0
        self.refused: list[str] = []

    def _entry_deeds(self) -> dict[str, Callable[[Entry], object]]:
        """What is done for an entry, by its name."""
        sim, contents = self._sim, self._sim.contents
        calls: dict[str, tuple[Callable[..., object], dict[str, _FieldDecoder]]] = {
            "publish": (sim.communication.bus.publish, {"topic": _text, "message": _message}),
            "call": (sim.call, {"service": _text, "request": _message}),
            "set": (sim.set_parameter, {"node": _text, "name": _text, "value": _parameter_value}),
            "remove": (sim.remove, {"name": _text}),
            "clone": (contents.clone, {"name": _text, "new_name": _text, "pose": _pose}),
            "add_sensor": (contents.add_sensor, {"name": _text, "sensor": _value}),
            "make_movable": (contents.make_movable, {"name": _text}),
            "add_weld": (contents.add_weld, {"name": _text, "parent_link": _text, "child_link": _text}),
            "set_weld": (contents.set_weld, {"name": _text, "closed": _is_true}),
            "reset": (sim.reset, {"seed": _seed_or_none}),
            "reseed": (sim.control.reseed, {"seed": _number}),
            "reset_models": (sim.control.reset_models, {}),
        }
        return {
            **{name: partial(_call_with_fields, act, fields) for name, (act, fields) in calls.items()},
            "advertise": self._advertise,
            "send": self._send,
            "close": self._close,
            "hear": self._hear,
            "by_hand": self._by_hand,
            "send_goal": self._send_goal,
            "cancel": self._cancel,
            "spawned": self._spawned,
            "snapshot": self._snapshot,
            "restore": self._restore,
        }

    @property
    def next_steps(self) -> int | None:
        """After how many steps something is to be done next between two steps; None when all is done."""
        return int(self._between[0]["steps"]) if self._between else None

    def play_due(self) -> None:
        """Does what is due at the present step.

        Raises:
            PluginError, SimulationDiverged: what was done had somebody raise, as it did in the run.
        """
        while self._between and self._between[0]["steps"] <= self._sim.engine.steps:
            self._play(self._between.popleft())

    def _play(self, entry: Entry) -> None:
        self.count += 1
        was_served = self._sim.control.pausing.is_served
        self._sim.control.pausing.is_served = entry.get("served") is True
        try:
            deed = self._deeds.get(entry["do"])
            if deed is None:
                raise MessageError(f"nothing is known of {entry['do']!r:.40}")
            deed(entry)
        except (InputError, KeyError, ValueError, TypeError, AttributeError) as error:
            # the run may have had the same answer, and gone on
            text = str(error) if isinstance(error, SimkitError) else repr(error)
            self.refused.append(f"{entry['do']} after {entry['steps']} steps: {text:.300}")
        finally:
            self._sim.control.pausing.is_served = was_served

    # ------------------------------------------------------------------ what can be done

    def _advertise(self, entry: Entry) -> None:
        topic, type_name, latched = _text(entry, "topic"), _text(entry, "type"), _is_true(entry, "latched")
        publisher = self._sim.communication.bus.advertise(topic, type_name, latched=latched)
        self._publishers[entry.get("number")] = publisher

    def _send(self, entry: Entry) -> None:
        message, publisher = _message(entry, "message"), self._publishers.get(entry.get("number"))
        if publisher is None:  # opened before the journal was
            self._sim.communication.bus.publish(_text(entry, "topic"), message)
        else:
            publisher.publish(message)

    def _close(self, entry: Entry) -> None:
        self._sim.communication.bus.close(self._publishers.pop(entry.get("number")))

    def _hear(self, entry: Entry) -> None:
        """A tap where the run had a callback; only where that did something."""
        heard = self._counting(entry.get("number"))
        if heard is not None:
            self._sim.communication.bus.tap(_text(entry, "topic"), heard)

    def _counting(self, number: object) -> Callable[[object], None] | None:
        """A callback that does, the n-th time it is called, what the run's did then; None where that did nothing."""
        deeds = self._within.get(_whole_number(number)) if number is not None else None
        if not deeds:
            return None
        count = 0

        def heard(_: object) -> None:
            nonlocal count
            count += 1
            while deeds and _whole_number(deeds[0]["in"][1]) <= count:
                self._play(deeds.popleft())

        return heard

    def _by_hand(self, entry: Entry) -> None:
        apply_changes(self._sim, dict(entry))

    def _send_goal(self, entry: Entry) -> None:
        feedback, done = (self._counting(entry.get(name)) for name in ("on_feedback", "on_done"))
        handle = self._sim.send_goal(_text(entry, "action"), _message(entry, "goal"), feedback, done)
        if handle.id in self._cancelled:
            self._goals[handle.id] = handle

    def _cancel(self, entry: Entry) -> None:
        self._goals[entry.get("goal")].cancel()

    def _spawned(self, entry: Entry) -> None:
        models = [(one["source"], one["name"], _decode_pose(one["pose"])) for one in entry["models"]]
        self._sim.contents.spawn_all(models)

    def _snapshot(self, entry: Entry) -> None:
        if entry.get("number") in self._restored:
            self._snapshots[entry.get("number")] = self._sim.snapshot()

    def _restore(self, entry: Entry) -> None:
        self._sim.restore(self._snapshots[entry.get("number")])


_FieldDecoder = Callable[[Entry, str], object]


def _call_with_fields(act: Callable[..., object], fields: Mapping[str, _FieldDecoder], entry: Entry) -> None:
    act(*(decode(entry, name) for name, decode in fields.items()))


def _text(entry: Entry, name: str) -> str:
    found = entry.get(name)
    if not isinstance(found, str):
        raise MessageError(f"{name}: found {found!r:.60}, allowed is a text")
    return found


def _message(entry: Entry, name: str) -> Message:
    return decode_message(entry.get(name))


def _value(entry: Entry, name: str) -> object:
    return decode_value(entry.get(name))


def _pose(entry: Entry, name: str) -> Pose | None:
    return _decode_pose(entry.get(name))


def _is_true(entry: Entry, name: str) -> bool:
    return entry.get(name) is True


def _number(entry: Entry, name: str) -> int:
    return _whole_number(entry.get(name))


def _seed_or_none(entry: Entry, name: str) -> int | None:
    return None if entry.get(name) is None else _number(entry, name)


def _parameter_value(entry: Entry, name: str) -> object:
    value = entry.get(name)
    return tuple(value) if isinstance(value, list) else value


def _whole_number(value: object) -> int:
    if type(value) is not int or not 0 <= value < 1 << 62:
        raise MessageError(f"found {value!r:.60}, allowed is a whole number from 0 on")
    return value


def _decode_pose(values: object) -> Pose | None:
    if values is None:
        return None
    if not isinstance(values, list) or len(values) != 7:
        raise MessageError(f"found {values!r:.80}, allowed are 7 numbers of a pose")
    x, y, z, *rotation = (float(v) for v in values)
    return Pose((x, y, z), tuple(rotation))
