"""Journal of all external inputs to a simulation, each with the number of steps made before it."""

from __future__ import annotations

import functools
import json
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakKeyDictionary, finalize, ref

from simkit import DeferredResponse, Pose
from simkit.extend import SceneModel
from simkit.msgs import Message
from simkit.run_spec import JsonObject
from simkit.runtime.communication.script_callback import ScriptCallback
from simkit_verification.testing.bundles.direct_changes import DirectChanges
from simkit_verification.testing.bundles.journal_values import DEFERRED, NotEncodable, encode_message, encode_value

if TYPE_CHECKING:
    from simkit import Publisher, Simulation
    from simkit.runtime.communication.action_server import Action
    from simkit.runtime.communication.journal import ResultStore
    from simkit.runtime.communication.parameter import Parameter
    from simkit.runtime.communication.service_server import Service
    from simkit.runtime.spawner import SpawnRequest

_MAX_BYTES_IN_MEMORY: Final = 16 << 20  # beyond this size [bytes], the journal continues in a temporary file
_CALLS_STORED_UNCHANGED: Final = (
    *(
        "accept_goal",
        "add_weld",
        "cancel",
        "continue_goal",
        "leave_controllers_to_nodes",
        "make_movable",
        "remove",
        "reseed",
        "reset",
    ),
    *("reset_models", "set_sensor_frame"),
)
"""Calls whose arguments are stored unchanged in the entry."""
MAX_JOURNAL_BYTES: Final = 1 << 30
"""Maximum size of a journal [bytes]."""

AnswerCallback = Callable[[object], None]


class JournalWriter:
    """Journal of a run from its first step on; see `simkit.runtime.communication.journal.Journal`.

    External inputs come from the caller and its callbacks, not from plugins or the engine.

    Args:
        sim: Simulation at t = 0, before any input.

    Attributes:
        count: Number of entries.
        gaps: Descriptions of inputs that could not be recorded.
        sources: Files and names from which models were read during the run, in order.
        keeper: Recorder that owns the journal.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._file = tempfile.SpooledTemporaryFile(max_size=_MAX_BYTES_IN_MEMORY)  # noqa: SIM115 - lives as long as the run
        finalize(self, self._file.close)
        self._inside = 0
        self._callback_position: list[int] | None = None
        self._callback_counts: dict[int, list[int]] = {}
        self._numbers: WeakKeyDictionary[object, int] = WeakKeyDictionary()
        self._callback_numbers: WeakKeyDictionary[object, int] = WeakKeyDictionary()
        self._endpoints: dict[int, tuple[object, int]] = {}
        self._snapshots: dict[int, tuple[ref[object], int]] = {}
        self._snapshot_count = 0
        self._direct_changes = DirectChanges(sim)
        self._entries: dict[str, Callable[..., JsonObject | None]] = {
            name.removeprefix("_of_"): getattr(self, name) for name in dir(self) if name.startswith("_of_")
        }
        self.count = 0
        self.gaps: list[str] = []
        self.sources: list[str] = []
        self.keeper: object = None

    def write_to(self, path: Path) -> None:
        """Copy all entries to a file."""
        self._record_direct_changes()
        self._file.seek(0)
        with path.open("wb") as file:
            while piece := self._file.read(1 << 20):
                file.write(piece)
        self._file.seek(0, 2)

    # ------------------------------------------------------------------ external calls

    @property
    def _is_outside(self) -> bool:
        return not self._inside and (self._callback_position is not None or not self._sim.engine.is_stepping)

    @contextmanager
    def passing(self, operation: str, arguments: Mapping[str, object]) -> Iterator[AnswerCallback | None]:
        """Record an external call; further calls that the simulation makes because of this call are not recorded."""
        if not self._is_outside:
            yield None
            return
        self._record_direct_changes()
        on_answer = self._record_call(operation, arguments)
        self._inside += 1
        try:
            yield on_answer
        finally:
            self._inside -= 1
            self._direct_changes.store_state()

    @contextmanager
    def called_back(self, callback: object) -> Iterator[ResultStore | None]:
        """Treat inputs from a callback as external, except if the callback belongs to a plugin."""
        number = self._numbers.get(callback)
        if number is None:  # the callback belongs to a plugin
            yield None
            return
        if isinstance(callback, ScriptCallback):
            self._callback_counts[number][1] += 1
        with self._outside_at(number):
            yield self._store_result

    @contextmanager
    def _outside_at(self, number: int) -> Iterator[None]:
        before = self._inside, self._callback_position
        self._inside, self._callback_position = 0, self._callback_counts[number]
        self._direct_changes.store_state()
        try:
            yield
        finally:
            self._record_direct_changes()
            self._inside, self._callback_position = before

    def outside(self, callback: Callable[[object], object] | None) -> Callable[[object], object] | None:
        """Wrap an external callback and count its calls; journal entries contain the number of the call."""
        if callback is None or not self._is_outside:
            return callback
        count = self._new_callback_counter()

        @functools.wraps(callback)
        def counted_callback(value: object) -> object:
            count[1] += 1
            with self._outside_at(count[0]):
                return callback(value)

        self._callback_numbers[counted_callback] = count[0]
        return counted_callback

    def _store_result(self, value: object) -> None:
        """Record the result of the active callback."""
        if isinstance(value, DeferredResponse):  # its message is recorded by `finish_call`
            self._write("return", {"value": DEFERRED})
            return
        try:
            self._write("return", {"value": encode_message(value) if hasattr(value, "__msgtype__") else value})
        except NotEncodable as error:
            self.gaps.append(f"the result of a callback cannot be stored by a bundle: {error}")

    def _numbered(self, callback: object) -> int | None:
        """Return the number of a script's callback; None if there is none."""
        if isinstance(callback, ScriptCallback) and callback not in self._numbers:
            self._numbers[callback] = self._new_callback_counter()[0]
        return None if callback is None else self._numbers.get(callback)

    def _new_callback_counter(self) -> list[int]:
        number = len(self._callback_counts) + 1
        counter = self._callback_counts[number] = [number, 0]
        return counter

    def hears(self, topic: str, subscription: object) -> None:
        """Count the messages of a new external subscriber; journal entries contain the number of the message."""
        if not self._is_outside:
            return
        count = self._new_callback_counter()
        number = self._numbers[subscription] = count[0]

        def count_message(_: object) -> None:
            count[1] += 1

        self._write("hear", {"number": number, "topic": topic})
        self._sim.communication.bus.tap(topic, count_message, takes_later=True)

    def before_steps(self) -> None:
        """Record direct changes to the physics before the next step."""
        if self._is_outside:
            self._record_direct_changes()

    def after_steps(self) -> None:
        """Store the state after a step, because changes by the step itself are not inputs."""
        if self._is_outside:
            self._direct_changes.store_state()

    def _record_direct_changes(self) -> None:
        changes = self._direct_changes.changes()
        if changes is not None:
            self._write("by_hand", changes)
            self._direct_changes.store_state()

    # ------------------------------------------------------------------ entries

    def _record_call(self, operation: str, arguments: Mapping[str, object]) -> AnswerCallback | None:
        """Write an entry and return the function that receives the result of the call; None if there is none."""
        try:
            entry: JsonObject | None = (
                dict(arguments) if operation in _CALLS_STORED_UNCHANGED else self._entries[operation](**arguments)
            )
        except NotEncodable as error:
            self.gaps.append(
                f"{operation} at t={self._sim.time:g} s had an argument that a bundle cannot store: {error}"
            )
            return None
        if entry is None:
            return None
        then: AnswerCallback | None = entry.pop("then", None)
        self._write(operation, entry)
        return then

    def _write(self, do: str, arguments: Mapping[str, object]) -> None:
        sim = self._sim
        entry: dict[str, object] = {"steps": sim.engine.steps, "tick": sim.tick, "do": do, **arguments}
        if self._callback_position is not None:
            entry["in"] = list(self._callback_position)
        if sim.control.pausing.is_served:
            entry["served"] = True
        line = json.dumps(entry).encode() + b"\n"
        if self._file.tell() + len(line) > MAX_JOURNAL_BYTES:
            if not self.gaps or "no more" not in self.gaps[-1]:
                limit = MAX_JOURNAL_BYTES >> 30
                self.gaps.append(f"no more commands are recorded from t={sim.time:g} s on: the limit is {limit} GiB")
            return
        self._file.write(line)
        self.count += 1

    # ------------------------------------------------------------------ entries by call name

    def _of_publish(self, topic: str, message: object) -> dict[str, object]:
        return {"topic": topic, "message": encode_message(message)}

    def _of_advertise(self, publisher: Publisher) -> dict[str, object]:
        number = self._number_of_endpoint(publisher)
        arguments = {"topic": publisher.topic, "type": publisher.type_name, "latched": publisher.latched}
        return {"number": number, **arguments}

    def _of_send(self, publisher: Publisher, message: Message) -> dict[str, object]:
        number = self._endpoints.get(id(publisher), (None, 0))[1]
        return {"number": number, "topic": publisher.topic, "message": encode_message(message)}

    def _number_of_endpoint(self, endpoint: object) -> int:
        """Return the number of a new publisher, command input, service, action or parameter."""
        return self._endpoints.setdefault(id(endpoint), (endpoint, len(self._endpoints) + 1))[1]

    def _of_listen(self, topic: str, types: tuple[str, ...], callback: object) -> dict[str, object]:
        arguments = {"topic": topic, "types": list(types), "callback": self._numbered(callback)}
        number = len(self._endpoints) + 1

        def store(listener: object) -> None:
            self._endpoints[id(listener)] = listener, number

        return {"number": number, **arguments, "then": store}

    def _of_relay(self, source: str, target: str, type_name: str) -> dict[str, object]:
        number = len(self._endpoints) + 1

        def store(relay: object) -> None:
            self._endpoints[id(relay)] = relay, number

        return {"number": number, "source": source, "target": target, "type": type_name, "then": store}

    _of_relay_inputs = _of_relay

    def _of_close(self, endpoint: object) -> dict[str, object] | None:
        known = self._endpoints.get(id(endpoint))
        return None if known is None else {"number": known[1]}

    def _of_call(self, service: Service, request: object) -> dict[str, object]:
        return {"service": service.name, "request": encode_message(request)}

    def _of_send_goal(self, action: str, goal: object, on_feedback: object, on_done: object) -> dict[str, object]:
        heard = self._outside_callbacks(on_feedback=on_feedback, on_done=on_done)
        return {"action": action, "goal": encode_message(goal), **heard}

    def _of_begin_call(self, service: str, request: object, on_done: object) -> dict[str, object]:
        return {"service": service, "request": encode_message(request), **self._outside_callbacks(on_done=on_done)}

    def _outside_callbacks(self, **callbacks: object) -> dict[str, object]:
        """Return the numbers of the callbacks that `outside` wrapped, by name."""
        numbers = {
            name: self._callback_numbers.get(callback) for name, callback in callbacks.items() if callback is not None
        }
        return {name: number for name, number in numbers.items() if number is not None}

    def _of_finish_call(self, call: int, response: object, error: str) -> dict[str, object]:
        return {"call": call, "response": None if response is None else encode_message(response), "error": error}

    def _of_offer(self, service: Service) -> dict[str, object]:
        entry = {"number": self._number_of_endpoint(service), "service": service.name, "type": service.type_name}
        if service.remote is not None:
            return {**entry, "node": service.remote.node}
        return {**entry, "callback": self._numbered(service.handler)}

    def _of_act(self, action: Action) -> dict[str, object]:
        entry = {"number": self._number_of_endpoint(action), "action": action.name, "type": action.type_name}
        callbacks = {"on_goal": self._numbered(action.on_goal), "on_cancel": self._numbered(action.on_cancel)}
        if action.node:
            callbacks = {"on_goal": None, "on_cancel": None}
        return {**entry, "node": action.node, **callbacks, "cancels": action.on_cancel is not None}

    def _of_end_goal(self, goal: int, status: int, result: object, reason: str) -> dict[str, object]:
        message = None if result is None else encode_message(result)
        return {"goal": goal, "status": int(status), "result": message, "reason": reason}

    def _of_send_feedback(self, goal: int, feedback: object) -> dict[str, object]:
        return {"goal": goal, "feedback": encode_message(feedback)}

    def _of_declare(self, parameter: Parameter[Any]) -> dict[str, object]:
        names = ("node", "name", "value", "minimum", "maximum", "choices", "description")
        values = {name: encode_value(getattr(parameter, name)) for name in names}
        number = self._number_of_endpoint(parameter)
        return {"number": number, **values, "callback": self._numbered(parameter.on_change)}

    def _of_set(self, node: str, name: str, value: object) -> dict[str, object]:
        return {"node": node, "name": name, "value": encode_value(value)}

    def _of_spawned(self, wanted: Iterable[SpawnRequest]) -> dict[str, object]:
        return {"models": [_encode_model_source(*request) for request in wanted]}

    def _of_clone(self, name: str, new_name: str, pose: Pose | None) -> dict[str, object]:
        return {"name": name, "new_name": new_name, "pose": _encode_pose(pose)}

    def _of_add_sensor(self, name: str, sensor: object) -> dict[str, object]:
        return {"name": name, "sensor": encode_value(sensor)}

    def _of_set_weld(self, name: str, closed: bool) -> dict[str, object]:
        return {"name": name, "closed": bool(closed)}

    def _of_snapshot(self, *, compact: bool) -> dict[str, object]:
        del compact  # a restored run has the same bits
        number = self._snapshot_count = self._snapshot_count + 1

        def remember(snapshot: object) -> None:
            key = id(snapshot)

            def forget(_: object) -> None:
                self._snapshots.pop(key, None)

            self._snapshots[key] = ref(snapshot, forget), number

        return {"number": number, "then": remember}

    def _of_restore(self, snapshot: object) -> dict[str, object] | None:
        known = self._snapshots.get(id(snapshot))
        if known is None:
            self.gaps.append(f"at t={self._sim.time:g} s a snapshot was restored that is older than the recording")
            return None
        return {"number": known[1]}


def _encode_pose(pose: Pose | None) -> list[float] | None:
    return None if pose is None else [*map(float, pose.position), *map(float, pose.quaternion)]


def _encode_model_source(source: object, name: str | None, pose: Pose | None) -> dict[str, object]:
    """Encode the source of a model to spawn: XML text, or a file or name as the caller wrote it."""
    if isinstance(source, SceneModel):
        raise NotEncodable("model created in Python")
    return {"source": str(source), "name": name, "pose": _encode_pose(pose)}
