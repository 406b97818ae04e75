"""Recorders of a run in short hashes: received messages, plugin calls, state changes and plugin attributes."""

from __future__ import annotations

import hashlib
import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Final
from zlib import crc32

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import Plugin, Simulation, msgs
from simkit.extend import Sensor
from simkit.msgs import Message
from simkit.packs import is_shipped_module
from simkit.recording.bags.bag_contents import matches_topic
from simkit.recording.message_taps import TopicTaps
from simkit.run_spec import JsonObject
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage
from simkit.runtime.engine.entity_structure import AttachedPlugin
from simkit_verification.testing.certify.outcome import PluginCall, TopicOutcome
from simkit_verification.testing.certify.variations import Listening

_MAX_DEPTH: Final = 24
_PLAIN: Final = (type(None), bool, int, str, bytes, complex)
_OWN_NAMES: Final = ("scoped", "topic", "name")


def short_hash(content: bytes) -> int:
    """Return a hash of 64 bits."""
    return int.from_bytes(hashlib.blake2b(content, digest_size=8).digest(), "little")


def value_hash(value: object) -> int:
    """Return a hash of a value with its items and attributes. Equal values have equal hashes in all processes."""
    return _update_hash(value, {}, 0)


def attribute_hashes(state: Mapping[str, object]) -> dict[str, int]:
    """Return the hash of each attribute of a plugin by name."""
    return {str(name): value_hash(value) for name, value in state.items()}


def short_value_text(value: object) -> str:
    """Return a value as short text; empty if it is too long."""
    if isinstance(value, (bool, int, float, str, np.number)):
        text = repr(value.item() if isinstance(value, np.number) else value)
        return text if len(text) <= 60 else text[:57] + "..."
    if isinstance(value, (tuple, list)) and len(value) <= 6:
        parts = [short_value_text(part) for part in value]
        return f"({', '.join(parts)})" if all(parts) else ""
    if isinstance(value, np.ndarray) and 0 < value.size <= 6:
        return short_value_text(tuple(value.ravel().tolist()))
    return ""


def _update_hash(value: object, seen: dict[int, tuple[int, object]], depth: int) -> int:
    kind = type(value)
    if isinstance(value, float) and kind is float:
        return short_hash(b"f" + (b"nan" if math.isnan(value) else value.hex().encode()))
    if kind in _PLAIN:
        return short_hash(f"{kind.__name__}:{value!r}".encode("utf-8", "backslashreplace"))
    if isinstance(value, np.ndarray) and value.dtype != object:
        return short_hash(f"{value.dtype.str}{value.shape}".encode() + np.ascontiguousarray(value).tobytes())
    if isinstance(value, np.generic):
        return short_hash(value.dtype.str.encode() + value.tobytes())
    if id(value) in seen or depth > _MAX_DEPTH:
        return short_hash(f"again {seen.get(id(value), (-1,))[0]}".encode())
    seen[id(value)] = len(seen), value  # store a reference, so that no other object gets the same id
    return _update_hash_of_items(value, seen, depth + 1)


def _update_hash_of_items(value: object, seen: dict[int, tuple[int, object]], depth: int) -> int:
    name = type(value).__name__
    if isinstance(value, Mapping):
        pairs = sorted((_update_hash(key, {}, depth), _update_hash(item, seen, depth)) for key, item in value.items())
        return short_hash(f"{name}{pairs}".encode())
    if isinstance(value, (set, frozenset)):
        return short_hash(f"{name}{sorted(_update_hash(item, {}, depth) for item in value)}".encode())
    if isinstance(value, (np.ndarray, list, tuple, deque)):
        return short_hash(f"{name}{[_update_hash(item, seen, depth) for item in value]}".encode())
    if isinstance(value, np.random.Generator):
        return _update_hash(value.bit_generator.state, seen, depth)
    if _is_handle(value):
        named = next((getattr(value, n) for n in _OWN_NAMES if isinstance(getattr(value, n, None), str)), "")
        return short_hash(f"{name} {named}".encode())
    attributes = _attributes(value)
    if attributes is None:
        return short_hash(f"{name} {getattr(value, '__qualname__', '')}".encode())
    parts = [(key, _update_hash(item, seen, depth)) for key, item in sorted(attributes.items())]
    return short_hash(f"{name}{parts}".encode())


def _is_handle(value: object) -> bool:
    """Check whether an object is shared by all copies of a state: a link, publisher, plugin, or the simulation."""
    copy = getattr(type(value), "__deepcopy__", None)
    return copy is not None and is_shipped_module(getattr(copy, "__module__", None) or "")


def _attributes(value: object) -> dict[str, object] | None:
    """Return the attributes of an object; None for functions, modules, classes and C objects."""
    if callable(value) and hasattr(value, "__qualname__"):
        return None
    listed = [vars(cls).get("__slots__", ()) for cls in type(value).__mro__]
    slots = [slot for names in listed for slot in ([names] if isinstance(names, str) else names)]
    attributes = {slot: getattr(value, slot) for slot in slots if hasattr(value, slot) and slot != "__dict__"}
    if hasattr(value, "__dict__") and not isinstance(value, type):
        attributes.update(vars(value))
    elif not slots:
        return None
    return attributes


UNKNOWN = -1


class TopicHashes:
    """Hashes of the messages on all topics of a run, including topics that are advertised later.

    Internal topics of the bus (such as `/stats`, which has wall-clock fields) are included only if `topics` names them.

    Args:
        sim: Simulation.
        how: Kind of subscription, see `Listening`.
        topics: Shell patterns of topics; empty for all.
        skip: Shell patterns of topics to leave out.
    """

    def __init__(self, sim: Simulation, how: Listening, topics: Sequence[str] = (), skip: Sequence[str] = ()) -> None:
        self._sim, self._how, self._topics, self._skip = sim, how, tuple(topics), tuple(skip)
        self._streams: dict[str, _TopicHash] = {}
        self.is_paused = False
        if how != "none":
            TopicTaps(sim, self._receiver_of).open()

    def take(self) -> None:
        """Hash the messages in the queues; the caller calls this method regularly between two steps."""
        for stream in self._streams.values():
            stream.take()

    def heard(self) -> dict[str, TopicOutcome]:
        """Return the hashes of the received messages by topic."""
        self.take()
        owners = _topic_publishers(self._sim)
        return {topic: stream.heard(owners.get(topic, "")) for topic, stream in sorted(self._streams.items())}

    def _receiver_of(self, topic: str, type_name: str) -> Callable[[Message], None] | None:
        if topic in self._streams or not self._is_selected(topic):
            return None
        stream = self._streams[topic] = _TopicHash(self, self._sim, type_name)
        if self._how == "kept":
            return stream.keep
        self._sim.subscribe(topic, stream.receive, keep=1)
        if self._how == "late":
            self._sim.subscribe(topic, lambda _: None, keep=3)
            self._sim.subscribe(topic, keep=2)
        return None  # use real subscriptions, so that the kind of subscription varies between runs

    def _is_selected(self, topic: str) -> bool:
        if topic in self._sim.communication.bus.aside and topic not in self._topics:
            return False
        return not matches_topic(topic, self._skip) and (not self._topics or matches_topic(topic, self._topics))


class _TopicHash:
    """Hashes of the messages on one topic."""

    def __init__(self, owner_hashes: TopicHashes, sim: Simulation, type_name: str) -> None:
        self._owner, self._sim, self._type_name = owner_hashes, sim, type_name
        self._digests: list[int] = []
        self._ticks: list[int] = []
        self._kept: list[Message] = []
        self._all = hashlib.sha256()

    def receive(self, message: object) -> None:
        """Hash a message at once; this method is a subscriber callback."""
        if not self._owner.is_paused:
            self._count(message, self._sim.tick)

    def keep(self, message: object) -> None:
        """Store a message or lazy message, which `TopicHashes.take` hashes later."""
        if not self._owner.is_paused:
            self._kept.append(message)

    def take(self) -> None:
        messages, self._kept = self._kept, []
        for message in messages:
            made = message.get() if isinstance(message, LazyMessage) else message
            if made is not NO_MESSAGE:
                self._count(made, UNKNOWN)

    def _count(self, message: object, tick: int) -> None:
        content = msgs.serialize(message)
        self._all.update(content)
        self._digests.append(short_hash(content))
        self._ticks.append(tick)

    def heard(self, owner: str) -> TopicOutcome:
        digests, ticks = np.array(self._digests, np.uint64), np.array(self._ticks, np.int64)
        return TopicOutcome(self._type_name, digests, ticks, self._all.hexdigest(), owner)


def _topic_publishers(sim: Simulation) -> dict[str, str]:
    """Return the titles of the publishers of each topic."""
    titles: dict[str, list[str]] = {}
    for topic, end, _, does in sim.communication.bus.endpoints():
        if does == "publishes" and end.owner is not None:
            titles.setdefault(topic, []).append(plugin_title(end.owner))
    return {topic: " and ".join(dict.fromkeys(names)) for topic, names in titles.items()}


def plugin_title(owner: object) -> str:
    """Return the name of a plugin or sensor for reports: `plugin 'drive' (robot.sdf:12)`."""
    if isinstance(owner, Plugin):
        name, where = f"{owner.scoped}::{owner.name}" if owner.scoped else owner.name, owner.where
    elif isinstance(owner, Sensor):
        name, where = owner.scoped or owner.name, owner.scene.where
    else:
        return type(owner).__name__
    place = f" ({where})" if where.line else ""
    return f"{'plugin' if isinstance(owner, Plugin) else 'sensor'} {name!r}{place}"


class PluginCallRecorder:
    """Recorder of every plugin call of a simulation, from its creation on.

    Args:
        sim: Simulation.

    Attributes:
        events: Recorded calls; the first ones have the attributes of all plugins after loading.
        is_paused: True while recording is paused.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.events: list[PluginCall] = []
        self.is_paused = False
        self._known: dict[int, dict[str, int]] = {}
        self._record_attributes()
        sim.engine.faults.observe(self._record)

    def begin_again(self) -> None:
        """Discard all recorded calls after a reset."""
        self.events.clear()
        self._known.clear()
        self._record_attributes()

    def _record(self, plugin: object, hook: str, call: Callable[[], object]) -> object:
        """Make a call and record what it changed."""
        if self.is_paused or not isinstance(plugin, Plugin):
            return call()
        engine = self._sim.engine
        before, tick = writable_state_hash(engine.physics.data), engine.tick
        try:
            return call()
        finally:
            self._note(plugin, hook, tick, before)

    def _record_attributes(self) -> None:
        for plugin in self._sim.engine.structure.all_plugins():
            self._note(plugin, "load", 0, writable_state_hash(self._sim.mj_data))

    def _note(self, plugin: AttachedPlugin, hook: str, tick: int, before: int) -> None:
        state = plugin_attributes(plugin)
        hashes = attribute_hashes(state)
        known = self._known.get(id(plugin), {})
        self._known[id(plugin)] = hashes
        changed = {name: value for name, value in hashes.items() if known.get(name) != value}
        changed.update({name: 0 for name in known if name not in hashes})
        shown = {name: short_value_text(state[name]) for name in changed if name in state}
        after = writable_state_hash(self._sim.engine.physics.data)
        self.events.append(PluginCall(tick, plugin_title(plugin), hook, before, after, changed, shown))


def plugin_attributes(plugin: AttachedPlugin) -> JsonObject:
    """Return the attributes of a plugin that a snapshot would store."""
    try:
        state = plugin.get_state()
    except Exception:  # noqa: BLE001 - a plugin may raise anything
        return {}
    if not isinstance(state, Mapping):
        return {"state": state}
    inner = state.get("variables")  # a gz system stores its attributes in this object
    return dict(inner if isinstance(inner, Mapping) else state)


def writable_state_hash(data: mujoco.MjData) -> int:
    """Return a hash of the values that plugins can write: state, controls and forces."""
    digest = 0
    for field in (data.qpos, data.qvel, data.act, data.ctrl, data.qfrc_applied, data.xfrc_applied, data.mocap_pos):
        digest = crc32(field.tobytes(), digest)
    return crc32(data.mocap_quat.tobytes(), digest)


class TickHashes:
    """Short hashes of the physics and of the inputs for every tick.

    Attributes:
        is_paused: True while recording is paused.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self.is_paused = sim, False
        self.state: dict[int, int] = {}
        self.inputs: dict[int, int] = {}
        sim.communication.on_demand.add(lambda: True, None, self._mark, "after")

    def rows(self, ticks: int) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.uint64]]:
        """Return the hashes of the physics and of the inputs, each with shape (ticks,)."""
        all_ticks = range(1, ticks + 1)
        state, inputs = ([of.get(tick, 0) for tick in all_ticks] for of in (self.state, self.inputs))
        return np.array(state, np.uint64), np.array(inputs, np.uint64)

    def _mark(self, _: int) -> None:
        if self.is_paused:
            return
        physics = self._sim.engine.physics
        data, tick = physics.data, physics.tick
        self.state[tick] = _two_hashes(data.qpos, data.qvel, data.act)
        applied, pushed = physics.applied_forces()
        self.inputs[tick] = _two_hashes(data.ctrl, applied, pushed, data.mocap_pos)


def _two_hashes(*fields: npt.NDArray[np.float64]) -> int:
    first = second = 0
    for field in fields:
        content = field.tobytes()
        first, second = crc32(content, first), crc32(content, second ^ 0x5BD1E995)
    return first | second << 32
