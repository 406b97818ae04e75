"""References of a pickled snapshot to the objects of a simulation: handles, sensors, plugins, publishers.

A reference has the name of the object, or its place in the state that its plugin had after `load`. Such a state is the
same in all processes, because the plugin has read the same file.
"""

from __future__ import annotations

import io
import pickle
import sys
import weakref
from collections import deque
from collections.abc import Iterator
from operator import attrgetter
from types import FunctionType, MappingProxyType, ModuleType
from typing import TYPE_CHECKING, Any, Final, Protocol

import mujoco
import numpy as np

from simkit.diagnostics import Diagnostics
from simkit.in_process import InProcess
from simkit.runtime.engine.entity_structure import WorldStructure
from simkit.runtime.engine.random_streams import RandomStream
from simkit.runtime.engine.snapshot import Snapshot
from simkit.runtime.handles.handle import Handle

if TYPE_CHECKING:
    from simkit.runtime.communication.communication import Communication
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.world_contents import WorldContents
    from simkit.runtime.world_source import LoadedState

Place = tuple[Any, ...]
"""Kind of a referenced object, followed by its name and the attributes, keys and positions that lead to it."""

_USER_PLUGINS: Final = "simkit_user_plugins."  # beginning of the module names of plugin files
_MOST_OBJECTS: Final = 200_000  # that are searched for references in the states of plugins


class SnapshotOwner(Protocol):
    """Parts of a simulation that its snapshots need."""

    engine: Engine
    communication: Communication
    contents: WorldContents
    loaded: LoadedState


class References:
    """References to the objects of a simulation.

    Args:
        sim: simulation.
        snapshot: snapshot whose states have references.
        has_states: False for descriptions of models, which exist before the states of their plugins.
    """

    def __init__(self, sim: SnapshotOwner, snapshot: Snapshot, *, has_states: bool = True) -> None:
        self._sim = sim
        self._structure = snapshot.structure
        self._model = snapshot.structure.compiled.model
        self._plugins = [plugin for plugin, _ in snapshot.plugins]
        first = sim.contents.spawner.first_states
        self._first = [first.get(id(plugin)) for plugin in self._plugins]
        self._roots: dict[int, Place] = {id(plugin): ("plugin", n) for n, plugin in enumerate(self._plugins)}
        systems = ((n, getattr(plugin, "system", None)) for n, plugin in enumerate(self._plugins))
        self._roots |= {id(system): ("system", n) for n, system in systems if system is not None}
        self._roots |= {id(sensor): ("sensor", n) for n, (sensor, _) in enumerate(snapshot.sensors)}
        self._sensors = [sensor for sensor, _ in snapshot.sensors]
        self._roots |= {id(item): ("parameter", *key) for key, item in self._parameters().items()}
        self._found: dict[int, Place] | None = None if has_states else {}

    def _parameters(self) -> dict[tuple[str, int], object]:
        table = self._sim.communication.live_parameters.entries()
        return {(node, n): item for node, of_node in table.items() for n, item in enumerate(of_node.values())}

    def place_of(self, value: object) -> Place | None:
        """Return the reference to an object; None for a value, which is stored itself."""
        kind = type(value)
        if kind in _VALUES:
            return None
        if value is self._sim:
            return ("simulation",)
        if isinstance(value, mujoco.MjModel):  # code that keeps an earlier one computes its values again
            return ("model", value is self._model)
        known_place = self._roots.get(id(value))
        if known_place is not None:
            return known_place
        if isinstance(value, Diagnostics):
            return ("diagnostics",)
        if isinstance(value, WorldStructure):  # a plugin that keeps an earlier one builds its lists again
            return ("structure", value is self._structure)
        if isinstance(value, RandomStream):
            return ("stream", value.scoped, value.channel, value.width)
        if isinstance(value, Handle):
            return _place_of_handle(value)
        if not _is_shared(value):
            return None
        if value is self._structure.builder.find_file:
            return ("find_file",)
        if self._found is None:
            self._found = {}
            for number, state in enumerate(self._first):
                for place, item in _shared_objects(state, ("state", number)):
                    self._found.setdefault(id(item), place)
        return self._found.get(id(value))

    def object_at(self, place: Place) -> object:
        """Return the object of a reference."""
        match place:
            case ("simulation",):
                return self._sim
            case ("model", is_present):
                return self._model if is_present else None
            case ("structure", is_present):
                return self._structure if is_present else None
            case ("diagnostics",):
                return Diagnostics()
            case ("find_file",):
                return self._structure.builder.find_file
            case ("plugin", number):
                return self._plugins[number]
            case ("system", number):
                return getattr(self._plugins[number], "system")  # noqa: B009 (only Gazebo's systems have it)
            case ("sensor", number):
                return self._sensors[number]
            case ("parameter", node, number):
                return self._parameters()[node, number]
            case ("stream", scoped, channel, width):
                return self._sim.engine.streams.stream(scoped, channel, width)
            case ("handle", kind, scoped):
                return _handle_at(self._sim, kind, scoped)
        _, number, *steps = place
        value: Any = self._first[number]
        for step in steps:
            value = _child(value, step)
        return value


_VALUES: Final = frozenset((int, float, str, bytes, bool, tuple, list, dict, set, type(None), np.ndarray, type))


def _is_shared(value: object) -> bool:
    """Check whether a deep copy shares an object instead of copying it, and a reference leads to it."""
    if getattr(value, "is_immutable_value", False):  # `simkit.plugins.not_deep_copied`
        return False
    return isinstance(value, FunctionType) or getattr(type(value), "__deepcopy__", None) is not None


def _place_of_handle(handle: Handle) -> Place:
    return ("handle", type(handle).__name__.lower(), handle.scoped)


def _handle_at(sim: SnapshotOwner, kind: str, scoped: str) -> object:
    handles = sim.contents.handles
    if kind == "visual":
        return handles.find_visual(scoped)
    if kind == "collision":
        link, _, name = scoped.rpartition("::")
        return handles.link(link).collisions[name]
    return handles.find(kind, scoped)


def _shared_objects(state: object, place: Place) -> Iterator[tuple[Place, object]]:
    """Yield the objects in a state that a deep copy shares, with their places; the nearest place comes first."""
    waiting: deque[tuple[Place, object]] = deque([(place, state)])
    seen: set[int] = set()
    while waiting and len(seen) < _MOST_OBJECTS:
        at, value = waiting.popleft()
        if id(value) in seen:
            continue
        seen.add(id(value))
        if at != place and _is_shared(value):
            yield at, value
        if isinstance(value, _CLOSED):
            continue
        waiting.extend(((*at, step), child) for step, child in _children(value) if type(child) not in _LEAVES)


_CLOSED: Final = (InProcess, Diagnostics, FunctionType, ModuleType, mujoco.MjModel, mujoco.MjData, np.ndarray)
"""Classes whose objects are not searched."""
_LEAVES: Final = frozenset((int, float, str, bytes, bool, type(None), np.ndarray, type))


def _children(value: object) -> Iterator[tuple[object, object]]:
    """Yield the attributes, entries or items of an object, with the steps that lead to them."""
    if isinstance(value, dict):
        yield from (
            (("key", key) if isinstance(key, str) else ("at", n), item) for n, (key, item) in enumerate(value.items())
        )
    elif isinstance(value, (list, tuple)):
        yield from ((("at", n), item) for n, item in enumerate(value))
    else:
        names = [*getattr(value, "__dict__", ())]
        names += [name for kind in type(value).__mro__ for name in _slots(kind) if hasattr(value, name)]
        yield from ((("name", name), getattr(value, name)) for name in names)


def _slots(kind: type) -> tuple[str, ...]:
    slots = vars(kind).get("__slots__", ())
    return (slots,) if isinstance(slots, str) else tuple(slots)


def _child(value: Any, step: tuple[str, Any]) -> Any:
    kind, key = step
    if kind == "name":
        return getattr(value, key)
    if kind == "at" and isinstance(value, dict):
        return list(value.values())[key]
    return value[key]


def _read_only(values: dict[object, object]) -> MappingProxyType[object, object]:
    return MappingProxyType(values)  # pickle cannot find the class itself under its name


def _named_in_module(module: str, name: str) -> object:
    """Return a class or function of a plugin's file, whose module name is no name for `import`."""
    return attrgetter(name)(sys.modules[module])


def _no_object() -> None:
    """Return None; called instead of a weak reference whose object is gone."""


class _Pickler(pickle.Pickler):
    def __init__(self, file: io.BytesIO, places: References) -> None:
        super().__init__(file, pickle.DEFAULT_PROTOCOL)
        self._places = places

    def persistent_id(self, value: object) -> Place | None:
        return self._places.place_of(value)

    def reducer_override(self, value: Any) -> Any:
        if type(value) is MappingProxyType:
            return _read_only, (dict(value),)
        if isinstance(value, weakref.ref):
            target = value()
            return (_no_object, ()) if self._places.place_of(target) is None else (weakref.ref, (target,))
        if isinstance(value, (type, FunctionType)) and str(value.__module__).startswith(_USER_PLUGINS):
            return _named_in_module, (value.__module__, value.__qualname__)
        return NotImplemented


class _Unpickler(pickle.Unpickler):
    def __init__(self, file: io.BytesIO, places: References) -> None:
        super().__init__(file)
        self._places = places

    def persistent_load(self, place: Place) -> object:
        return self._places.object_at(place)


def dump_state(value: object, places: References) -> bytes:
    """Return a state as bytes, with references to the objects of a simulation."""
    file = io.BytesIO()
    _Pickler(file, places).dump(value)
    return file.getvalue()


def load_state(content: bytes, places: References) -> Any:
    """Return a state from `dump_state`, with the objects of another simulation."""
    return _Unpickler(io.BytesIO(content), places).load()
