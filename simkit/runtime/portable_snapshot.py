"""Snapshots for another process: a snapshot as bytes, and its restoration in another simulation of the same world.

The bytes have references instead of the objects that belong to a process: handles, sensors, plugins, publishers, …
Each such object is found again by its name, or by its place in the state that its plugin had after `load`. The world
itself is not stored. The other simulation repeats the spawns, removals and other changes of the structure, and its
compiled model must then be equal.
"""

from __future__ import annotations

import copy
import hashlib
import pickle
import zlib
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import mujoco

from simkit.errors import ArgumentTypeError, ArgumentValueError
from simkit.number_text import counted
from simkit.runtime.engine.entity_structure import WorldStructure
from simkit.runtime.engine.heap_resistance import clear_resistance
from simkit.runtime.engine.snapshot import Snapshot
from simkit.runtime.snapshot_references import References, SnapshotOwner, dump_state, load_state

if TYPE_CHECKING:
    from simkit.runtime.engine.entity_structure import AttachedSensor


_PLAIN_FIELDS: Final = ("fields", "physics", "seed", "inbox")
_AWAKE: Final = ("nbody_awake", "ntree_awake", "nv_awake")  # MuJoCo's own pickles of the data do not have them


@dataclass(frozen=True)
class PortableSnapshot:
    """Pickled snapshot; `Simulation.restore` accepts it in a simulation of the same world.

    Attributes:
        tick: tick of the state.
        time: simulated time of the state [s].
        size: number of bytes of the state.
        content: the state.
    """

    tick: int
    time: float
    content: bytes

    @property
    def size(self) -> int:
        return len(self.content)

    def __reduce__(self) -> tuple[type[PortableSnapshot], tuple[int, float, bytes]]:
        return PortableSnapshot, (self.tick, self.time, self.content)

    def __repr__(self) -> str:
        return f"<PortableSnapshot at t={self.time:g} s, {counted(self.size, 'byte')}>"


def pack_snapshot(sim: SnapshotOwner, snapshot: Snapshot) -> PortableSnapshot:
    """Return a snapshot for another process.

    Raises:
        ArgumentTypeError: a state contains an object that exists only in this process.
    """
    places = References(sim, snapshot)
    structure = snapshot.structure

    def packed(owner: str, value: object, places: References = places) -> bytes:
        try:
            return dump_state(value, places)
        except Exception as error:
            message = f"the snapshot cannot be pickled, because of the state of {owner}: {error}"
            raise ArgumentTypeError(message) from error

    def packed_sensor(sensor: AttachedSensor, state: object) -> bytes:
        with suppress(Exception):
            return dump_state(state, places)
        sensor.measure_pending(state)  # a sample that is not measured yet may refer to other objects of this process
        return packed(f"sensor {sensor.scoped!r}", state)

    model = _compiled_model(sim, structure)
    head, _, tail = _to_bytes(snapshot.data).partition(_to_bytes(structure.compiled.model))
    content = {
        "changes": packed("spawned models", structure.changes, References(sim, snapshot, has_states=False)),
        "memory": structure.builder.spec.memory,
        "model": _fingerprint(model),
        "data": (head, tail, {name: getattr(snapshot.data, name) for name in _AWAKE}),
        "plain": packed("the simulation", {name: getattr(snapshot, name) for name in _PLAIN_FIELDS}),
        "sensors": [packed_sensor(sensor, state) for sensor, state in snapshot.sensors],
        "plugins": [packed(f"plugin {plugin.name!r}", state) for plugin, state in snapshot.plugins],
        "handles": [packed(type(part).__name__, state) for part, state in snapshot.handles],
    }
    return PortableSnapshot(
        snapshot.tick, sim.engine.clock.time(snapshot.tick), zlib.compress(pickle.dumps(content), 1)
    )


def unpack_snapshot(sim: SnapshotOwner, portable: PortableSnapshot) -> Snapshot:
    """Return a pickled snapshot as a snapshot of a simulation, which afterwards has the structure of the snapshot.

    Raises:
        ArgumentValueError: the simulation has another world, or a class of the snapshot is missing, because another
            version of simkit or of a plugin took it. The simulation is then unchanged.
    """
    spawner = sim.contents.spawner
    content = pickle.loads(zlib.decompress(portable.content))
    before = spawner.snapshots.take()
    try:
        memory = content["memory"]
        if (content["changes"], memory) != (_changes_of(sim, before), before.structure.builder.spec.memory):
            spawner.snapshots.restore(sim.loaded.snapshot)
            places = References(sim, spawner.snapshots.take(), has_states=False)
            if sim.engine.structure.builder.spec.memory != memory:
                spawner.reserve_memory(memory)
            for name, arguments in load_state(content["changes"], places):
                getattr(spawner, name)(*arguments)
        return _bound(sim, content, spawner.snapshots.take())
    except Exception as error:
        spawner.undo(before)
        message = "the snapshot cannot be restored, because this simulation has another world or other overrides"
        help_ = "load it with the `run_spec` of the simulation that took the snapshot"
        if isinstance(error, ImportError):
            message = "the snapshot cannot be restored, because another version of simkit or of a plugin took it"
            help_ = "restore it with that version"
        raise ArgumentValueError(f"{message}: {error}", help=help_) from error


def _changes_of(sim: SnapshotOwner, snapshot: Snapshot) -> bytes:
    """Return the changes of a structure as bytes; empty if they cannot be pickled."""
    try:
        return dump_state(snapshot.structure.changes, References(sim, snapshot, has_states=False))
    except Exception:  # noqa: BLE001 - any object may be part of a scene
        return b""


def _bound(sim: SnapshotOwner, content: dict[str, Any], now: Snapshot) -> Snapshot:
    """Return the snapshot whose structure a simulation has already.

    Args:
        sim: simulation.
        content: content of the pickled snapshot.
        now: snapshot of the present state of the simulation.
    """
    structure = now.structure
    if _fingerprint(_compiled_model(sim, structure)) != content["model"]:
        raise ArgumentValueError("the compiled models differ")
    counts = [(len(content[kind]), len(getattr(now, kind))) for kind in ("sensors", "plugins", "handles")]
    if any(stored != present for stored, present in counts):
        raise ArgumentValueError(f"the numbers of sensors, plugins or handles differ: {counts}")
    places = References(sim, now)
    head, tail, awake = content["data"]
    data: Any = mujoco.MjData.__new__(mujoco.MjData)
    data.__setstate__(head + _to_bytes(structure.compiled.model) + tail)
    for name, value in awake.items():
        setattr(data, name, value)
    fields: dict[str, Any] = load_state(content["plain"], places)
    for kind in ("sensors", "plugins", "handles"):
        pairs = zip(getattr(now, kind), content[kind], strict=True)
        fields[kind] = [(owner, load_state(state, places)) for (owner, _), state in pairs]
    return replace(now, structure=structure, data=data, **fields)


# ---------------------------------------------------------------------- model


def _compiled_model(sim: SnapshotOwner, structure: WorldStructure) -> mujoco.MjModel:
    """Return a copy of the compiled model of a structure, without the changes of a program and of heaps."""
    model = copy.copy(structure.compiled.model)
    if structure is sim.engine.structure:
        for field, original in sim.engine.originals.items():
            getattr(model, field)[:] = original
    clear_resistance(model, model.dof_frictionloss)
    model.opt.gravity[:] = 0.0
    model.stat.meaninertia = model.stat.meanmass = 0.0  # they follow from changed masses
    return model


def _fingerprint(model: mujoco.MjModel) -> str:
    return hashlib.sha256(_to_bytes(model)).hexdigest()


def _to_bytes(of_engine: Any) -> bytes:
    """Return the engine's own bytes of a model or of data."""
    data: bytes = of_engine.__getstate__()
    return data
