"""Player that repeats the entries of a journal with the same calls, between the same two steps of the simulation."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from simkit import DeferredResponse, Pose
from simkit.errors import InputError, MessageError, SimkitError
from simkit.extend import counted
from simkit.msgs.goal_status import GoalStatus
from simkit.run_spec import JsonMapping
from simkit.runtime.communication.parameter import Parameter
from simkit_verification.testing.bundles.direct_changes import apply_changes
from simkit_verification.testing.bundles.journal_values import DEFERRED, decode_message, decode_value

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.extend import GoalHandle
    from simkit.runtime import Snapshot
    from simkit.runtime.communication.service_server import ServiceCall

Entry = JsonMapping


class AbsentServer:
    """Process that offered a service in the recorded run. Its responses are in the journal.

    Attributes:
        node: name of the process.
        is_busy: True, because no code may wait for the process.
    """

    is_busy = True

    def __init__(self, node: str) -> None:
        self.node = node

    def send(self, call: ServiceCall) -> None:
        """Do nothing: the journal has the response."""

    def wait(self, seconds: float) -> bool:
        """Return False: the journal has the response."""
        return False


class JournalPlayer:
    """Player of a journal.

    Args:
        sim: Simulation at t = 0.
        entries: Journal entries in order.

    Attributes:
        count: Number of entries played.
        refused: Descriptions of entries that the simulation rejected. Either the original run rejected them too, or the
            worlds differ.
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
                self._within[_integer_field(place[0])].append(entry)
            if entry["do"] == "restore":
                self._restored.add(entry.get("number"))
            if entry["do"] == "cancel":
                self._cancelled.add(entry.get("goal"))
        self._snapshots: dict[object, Snapshot] = {}
        self._goals: dict[object, GoalHandle] = {}
        self._endpoints: dict[object, Any] = {}
        self.count = 0
        self.refused: list[str] = []

    @property
    def next_steps(self) -> int | None:
        """Number of steps before the next entry between two steps; None after the last one."""
        return int(self._between[0]["steps"]) if self._between else None

    def play_due(self) -> None:
        """Play all entries that are due at the present step.

        Raises:
            PluginError, SimulationDiverged: An entry raised this error; it did so in the original run too.
        """
        while self._between and self._between[0]["steps"] <= self._sim.engine.steps:
            self._play(self._between.popleft())

    def _play(self, entry: Entry) -> None:
        self.count += 1
        was_served = self._sim.control.pausing.is_served
        self._sim.control.pausing.is_served = entry.get("served") is True
        try:
            method = _ENTRY_METHODS.get(entry["do"])
            if method is None:
                raise MessageError(f"unknown entry {entry['do']!r:.40}")
            method(self, entry)
        except (InputError, KeyError, ValueError, TypeError, AttributeError) as error:
            # the run may have raised the same error, caught it and continued
            text = str(error) if isinstance(error, SimkitError) else repr(error)
            self.refused.append(f"{entry['do']} after {counted(entry['steps'], 'step')}: {text:.300}")
        finally:
            self._sim.control.pausing.is_served = was_served

    # ------------------------------------------------------------------ entries

    def _publish(self, entry: Entry) -> None:
        self._sim.communication.bus.publish(_text_field(entry, "topic"), decode_message(entry.get("message")))

    def _advertise(self, entry: Entry) -> None:
        topic, type_name = _text_field(entry, "topic"), _text_field(entry, "type")
        publisher = self._sim.communication.bus.advertise(topic, type_name, latched=entry.get("latched") is True)
        self._endpoints[entry.get("number")] = publisher

    def _send(self, entry: Entry) -> None:
        message, publisher = decode_message(entry.get("message")), self._endpoints.get(entry.get("number"))
        if publisher is None:  # advertised before the journal began
            self._sim.communication.bus.publish(_text_field(entry, "topic"), message)
        else:
            publisher.publish(message)

    def _close(self, entry: Entry) -> None:
        endpoint = self._endpoints.pop(entry.get("number"))
        if isinstance(endpoint, Parameter):
            self._sim.communication.live_parameters.remove(endpoint)
        else:
            endpoint.close()

    def _listen(self, entry: Entry) -> None:
        types, called = [str(name) for name in entry["types"]], self._answering(entry.get("callback"))
        self._endpoints[entry.get("number")] = self._sim.listen(_text_field(entry, "topic"), types, called)

    def _relay(self, entry: Entry) -> None:
        names = [_text_field(entry, name) for name in ("source", "target", "type")]
        self._endpoints[entry.get("number")] = self._sim.communication.relay(*names)

    def _relay_inputs(self, entry: Entry) -> None:
        names = [_text_field(entry, name) for name in ("source", "target", "type")]
        self._endpoints[entry.get("number")] = self._sim.communication.relay_inputs(*names)

    def _offer(self, entry: Entry) -> None:
        node, called = entry.get("node"), self._answering(entry.get("callback"))
        remote = None if node is None else AbsentServer(str(node))
        name, type_name = _text_field(entry, "service"), _text_field(entry, "type")
        service = self._sim.communication.services.offer(name, type_name, called, remote=remote)
        self._endpoints[entry.get("number")] = service

    def _act(self, entry: Entry) -> None:
        on_cancel = self._answering(entry.get("on_cancel")) if entry.get("cancels") is True else None
        name, type_name, node = (_text_field(entry, field) for field in ("action", "type", "node"))
        on_goal = self._answering(entry.get("on_goal"))
        action = self._sim.communication.actions.act(name, type_name, on_goal, on_cancel, node=node)
        self._endpoints[entry.get("number")] = action

    def _declare(self, entry: Entry) -> None:
        options: dict[str, Any] = {name: entry.get(name) for name in ("minimum", "maximum", "choices", "description")}
        node, name = _text_field(entry, "node"), _text_field(entry, "name")
        called = self._callback_for_entries(entry.get("callback"))
        value: Any = entry.get("value")
        self._endpoints[entry.get("number")] = self._sim.declare(name, value, node=node, on_change=called, **options)

    def _answering(self, number: object) -> Callable[[Any], Any]:
        """Return a callback that plays the entries of the run's callback and returns its results."""
        return self._callback_for_entries(number) or (lambda _: None)

    def _hear(self, entry: Entry) -> None:
        """Subscribe to a topic of the run, if the callback of that subscription made inputs to the simulation."""
        callback = self._callback_for_entries(entry.get("number"))
        if callback is not None:
            self._sim.communication.bus.tap(_text_field(entry, "topic"), callback)

    def _callback_for_entries(self, number: object) -> Callable[[Any], Any] | None:
        """Return a callback whose n-th call plays the entries that the run's callback wrote in its n-th call.

        The callback returns the result that the run's callback returned in this call.

        Returns:
            The callback; None if the run's callback wrote no entries.
        """
        pending = self._within.get(_integer_field(number)) if number is not None else None
        if not pending:
            return None
        count = 0

        def play_pending(_: object) -> object:
            nonlocal count
            count += 1
            result = None
            while pending and _integer_field(pending[0]["in"][1]) <= count:
                entry = pending.popleft()
                if entry["do"] == "return":
                    result, self.count = entry.get("value"), self.count + 1
                else:
                    self._play(entry)
            if result == DEFERRED:
                return DeferredResponse()
            return decode_message(result) if isinstance(result, dict) else result

        return play_pending

    def _by_hand(self, entry: Entry) -> None:
        apply_changes(self._sim, dict(entry))

    def _call(self, entry: Entry) -> None:
        self._sim.communication.services.request(_text_field(entry, "service"), decode_message(entry.get("request")))

    def _send_goal(self, entry: Entry) -> None:
        feedback, done = (self._callback_for_entries(entry.get(name)) for name in ("on_feedback", "on_done"))
        handle = self._sim.send_goal(_text_field(entry, "action"), decode_message(entry.get("goal")), feedback, done)
        if handle.id in self._cancelled:
            self._goals[handle.id] = handle

    def _begin_call(self, entry: Entry) -> None:
        services, request = self._sim.communication.services, decode_message(entry.get("request"))
        services.begin(_text_field(entry, "service"), request, self._callback_for_entries(entry.get("on_done")))

    def _finish_call(self, entry: Entry) -> None:
        services, response = self._sim.communication.services, entry.get("response")
        message = None if response is None else decode_message(response)
        services.finish(services.waiting(_integer_field(entry.get("call"))), message, _text_field(entry, "error"))

    def _goal(self, entry: Entry) -> GoalHandle:
        return self._sim.communication.actions.goal(_integer_field(entry.get("goal")))

    def _accept_goal(self, entry: Entry) -> None:
        self._goal(entry).accept()

    def _continue_goal(self, entry: Entry) -> None:
        self._goal(entry).continue_goal()

    def _send_feedback(self, entry: Entry) -> None:
        self._goal(entry).publish_feedback(decode_message(entry.get("feedback")))

    def _end_goal(self, entry: Entry) -> None:
        result = None if entry.get("result") is None else decode_message(entry.get("result"))
        status = GoalStatus(_integer_field(entry.get("status")))
        self._goal(entry).end(status, result, _text_field(entry, "reason"))

    def _cancel(self, entry: Entry) -> None:
        self._goals[entry.get("goal")].cancel()

    def _set(self, entry: Entry) -> None:
        value = entry.get("value")
        value = tuple(value) if isinstance(value, list) else value
        self._sim.set_parameter(_text_field(entry, "node"), _text_field(entry, "name"), value)

    def _spawned(self, entry: Entry) -> None:
        models = [(model["source"], model["name"], _decode_pose(model["pose"])) for model in entry["models"]]
        self._sim.contents.spawn_all(models)

    def _remove(self, entry: Entry) -> None:
        self._sim.remove(_text_field(entry, "name"))

    def _clone(self, entry: Entry) -> None:
        name, new_name = _text_field(entry, "name"), _text_field(entry, "new_name")
        self._sim.contents.clone(name, new_name, _decode_pose(entry.get("pose")))

    def _add_sensor(self, entry: Entry) -> None:
        sensor = decode_value(entry.get("sensor"))
        if not isinstance(sensor, str | dict):
            raise MessageError(f"sensor: found {sensor!r:.60}, expected a string or a mapping")
        self._sim.contents.add_sensor(_text_field(entry, "name"), sensor)

    def _make_movable(self, entry: Entry) -> None:
        self._sim.contents.make_movable(_text_field(entry, "name"))

    def _add_weld(self, entry: Entry) -> None:
        self._sim.contents.add_weld(*(_text_field(entry, name) for name in ("name", "parent_link", "child_link")))

    def _set_sensor_frame(self, entry: Entry) -> None:
        self._sim.contents.set_sensor_frame(_text_field(entry, "name"), _text_field(entry, "frame"))

    def _set_weld(self, entry: Entry) -> None:
        self._sim.contents.set_weld(_text_field(entry, "name"), entry.get("closed") is True)

    def _reset(self, entry: Entry) -> None:
        seed = entry.get("seed")
        self._sim.reset(None if seed is None else _integer_field(seed))

    def _reseed(self, entry: Entry) -> None:
        self._sim.control.reseed(_integer_field(entry.get("seed")))

    def _leave_controllers_to_nodes(self, _: Entry) -> None:
        self._sim.control.leave_controllers_to_nodes()

    def _reset_models(self, _: Entry) -> None:
        self._sim.control.reset_models()

    def _snapshot(self, entry: Entry) -> None:
        if entry.get("number") in self._restored:
            self._snapshots[entry.get("number")] = self._sim.snapshot()

    def _restore(self, entry: Entry) -> None:
        self._sim.restore(self._snapshots[entry.get("number")])


_ENTRY_METHODS: dict[str, Callable[[JournalPlayer, Entry], None]] = {
    name: getattr(JournalPlayer, f"_{name}")
    for name in (
        *("publish", "advertise", "send", "close", "hear", "by_hand", "call", "send_goal", "cancel", "set", "spawned"),
        *("listen", "relay", "relay_inputs", "offer", "act", "declare", "begin_call", "finish_call"),
        *("accept_goal", "continue_goal", "send_feedback", "end_goal"),
        *("remove", "clone", "add_sensor", "make_movable", "add_weld", "set_weld", "reset", "reseed"),
        "leave_controllers_to_nodes",
        *("reset_models", "set_sensor_frame", "snapshot", "restore"),
    )
}


def _text_field(entry: Entry, name: str) -> str:
    value = entry.get(name)
    if not isinstance(value, str):
        raise MessageError(f"{name}: found {value!r:.60}, expected a string")
    return value


def _integer_field(value: object) -> int:
    if type(value) is not int or not 0 <= value < 1 << 62:
        raise MessageError(f"found {value!r:.60}, expected an integer >= 0")
    return value


def _decode_pose(values: object) -> Pose | None:
    if values is None:
        return None
    if not isinstance(values, list) or len(values) != 7:
        raise MessageError(f"found {values!r:.80}, expected the 7 numbers of a pose")
    x, y, z, *rotation = (float(v) for v in values)
    return Pose((x, y, z), tuple(rotation))
