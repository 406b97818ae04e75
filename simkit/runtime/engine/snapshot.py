"""Snapshots of the whole state of a simulation at one tick: take, restore and hash."""

from __future__ import annotations

import copy
import hashlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn, Protocol

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.argument_checks import wrong_type
from simkit.compiler.state_transfer import restore_compiled_fields
from simkit.errors import ArgumentValueError
from simkit.in_process import InProcess
from simkit.memory_error import memory_errors
from simkit.runtime.engine.physics_state import INTEGRATION_STATE

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.entity_structure import AttachedPlugin, AttachedSensor, AttachedState, WorldStructure
    from simkit.runtime.engine.physics_state import PhysicsMemory


@dataclass(frozen=True, repr=False)
class Snapshot(InProcess):
    """State that `restore` brings back; made by `Simulation.snapshot`.

    A snapshot that a hook or callback requests is taken at the end of the present step. The snapshot then includes the
    other tasks of that tick; without them, a restored run would not repeat. Before the end of the step, the snapshot
    has only the attribute `owner`.

    Attributes:
        structure: structure of the world.
        data: MuJoCo's data; in a compact snapshot their state vector (`mjSTATE_INTEGRATION`).
        fields: fields of the model that were written to, and its gravity.
        sensors, plugins: their states.
        handles: states of all other parts, in the order of restoring.
        inbox: commands that wait for the next step.
        physics: state of the physics beside MuJoCo's data.
        seed: seed of all random streams.
        owner: simulation of the snapshot.
        variant: number of changes of the world by other overrides before the snapshot.
        pack: function that returns the snapshot for another process.
    """

    _internal_names = frozenset(
        (
            *("fields", "handles", "inbox", "owner", "pack", "structure", "variant", "physics", "plugins"),
            *("sensors", "data"),
        )
    )

    structure: WorldStructure
    data: mujoco.MjData | npt.NDArray[np.float64]
    fields: dict[str, npt.NDArray[np.float64]]
    sensors: list[tuple[AttachedSensor, AttachedState]]
    plugins: list[tuple[AttachedPlugin, AttachedState]]
    handles: list[tuple[Stateful, AttachedState]]
    inbox: tuple[tuple[str, object], ...]
    physics: PhysicsMemory
    seed: int = 0
    owner: object = None
    variant: int = 0
    pack: Callable[[Snapshot], PackedSnapshot] | None = None

    @property
    def tick(self) -> int:
        """Tick of the state."""
        return self.physics.tick

    @property
    def time(self) -> float:
        """Simulated time of the state [s]."""
        return self._packed().time

    @property
    def size(self) -> int:
        """Number of bytes of the snapshot for another process; they are counted at each call."""
        return self._packed().size

    @property
    def is_complete(self) -> bool:
        """True if the snapshot can be restored, because the step in which it was requested has ended."""
        return "data" in vars(self)

    def __repr__(self) -> str:
        return f"<Snapshot at tick {self.tick}>" if self.is_complete else "<Snapshot of a step that has not ended>"

    def __reduce__(self) -> Any:
        return self._packed().__reduce__()

    def _packed(self) -> PackedSnapshot:
        if not self.is_complete or self.pack is None:
            message = "the snapshot was requested in a step that has not ended; pickle it after that step"
            raise ArgumentValueError(message)
        if isinstance(self.data, np.ndarray):
            raise ArgumentValueError("a compact snapshot cannot be pickled; leave out compact=True")
        return self.pack(self)

    def __getattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"a snapshot has no {name!r} before the end of the step in which it was requested")


class PackedSnapshot(Protocol):
    """Snapshot for another process."""

    @property
    def time(self) -> float:
        """Simulated time of the state [s]."""

    @property
    def size(self) -> int:
        """Number of bytes of the state."""

    def __reduce__(self) -> Any:
        """Return the function and the arguments that create the snapshot again."""


class Stateful(Protocol):
    """Part of a simulation with a state of its own."""

    def get_state(self) -> AttachedState:
        """Return the state for a snapshot."""

    def set_state(self, state: AttachedState) -> None:
        """Restore a state from `get_state`."""


class WaitingCommands(Protocol):
    """Commands that wait for the next step."""

    def values(self) -> Iterable[tuple[str, object]]:
        """Return the commands in the order of arrival."""

    def refill(self, entries: Iterable[tuple[str, object]]) -> None:
        """Replace all commands."""


class Snapshots:
    """Functions to take and restore snapshots of a simulation.

    Args:
        owner: the simulation.
        engine: engine of the simulation.
        parts: function that returns every part with a state, except sensors and plugins, in the order of restoring.
        commands: commands that wait for the next step.
        adopt: function that switches to another structure.
        pack: function that returns a snapshot for another process.

    Attributes:
        variant: number of changes of the world by other overrides.
    """

    def __init__(
        self,
        owner: object,
        engine: Engine,
        parts: Callable[[], Sequence[Stateful]],
        commands: WaitingCommands,
        adopt: Callable[[WorldStructure], None],
        pack: Callable[[Snapshot], PackedSnapshot],
    ) -> None:
        self._owner, self._engine, self._parts, self._commands = owner, engine, parts, commands
        self._adopt, self._pack = adopt, pack
        self.variant = 0

    def begin_variant(self) -> int:
        """Count a change of the world by other overrides, which makes earlier snapshots invalid; return the number."""
        self.variant += 1
        return self.variant

    def defer(self) -> tuple[Snapshot, Callable[[], None]]:
        """Return a snapshot that is not yet taken, and the function that takes it."""
        pending: Snapshot = object.__new__(Snapshot)
        vars(pending)["owner"] = self._owner
        return pending, lambda: vars(pending).update(vars(self.take()))

    def check(self, snapshot: object) -> None:
        """Raise an error if a value is not a complete snapshot of this simulation."""
        if not isinstance(snapshot, Snapshot):
            raise wrong_type("snapshot", "a result of `snapshot()`", snapshot)
        if snapshot.owner is not self._owner:
            raise ArgumentValueError("the snapshot belongs to another simulation; restore only snapshots of this one")
        if not snapshot.is_complete:
            message = "the snapshot was requested in a step that has not ended; restore it after that step"
            raise ArgumentValueError(message)
        if snapshot.variant != self.variant:
            raise ArgumentValueError("the snapshot is from before the world got other overrides")

    @memory_errors()
    def take(self, *, compact: bool = False) -> Snapshot:
        """Take a snapshot of the present state.

        Args:
            compact: store the state vector instead of MuJoCo's data, which take 0.2 MB and ten times as long. Where
                bodies may sleep or rest, the data are stored all the same, because that is no part of the vector.
        """
        engine = self._engine
        model, structure, physics = engine.mj_model, engine.structure, engine.physics
        plugins = [
            (p, engine.faults.state_of(p)) for p in structure.all_plugins()
        ]  # first, because `get_state` may disable a plugin
        data = physics.state_vector() if compact and not physics.sleep.counts else copy.copy(physics.data)
        fields = {f: getattr(model, f).copy() for f in engine.originals}
        fields["gravity"] = model.opt.gravity.copy()
        return Snapshot(
            structure=structure,
            data=data,
            fields=fields,
            sensors=[(s, s.get_state()) for s in structure.all_sensors()],
            plugins=plugins,
            handles=[(part, part.get_state()) for part in self._parts()],
            inbox=tuple(self._commands.values()),
            physics=physics.get_state(),
            seed=engine.streams.seed,
            owner=self._owner,
            variant=self.variant,
            pack=self._pack,
        )

    def restore(self, snapshot: Snapshot, *, with_inbox: bool = True) -> None:
        """Restore a snapshot; the caller must rebuild the schedule.

        Args:
            snapshot: snapshot of this simulation.
            with_inbox: True to restore the commands that wait for the next step too. False only undoes a failed change:
                the waiting commands stay, and time continues.
        """
        engine = self._engine
        if snapshot.structure is not engine.structure:
            left, originals = engine.mj_model, dict(engine.originals)
            for sensor in engine.structure.all_sensors() if originals else ():
                sensor.take_held()
            engine.originals.clear()
            self._adopt(snapshot.structure)
            restore_compiled_fields(left, originals)
        model, physics = engine.mj_model, engine.physics
        for field, original in engine.originals.items():
            getattr(model, field)[:] = snapshot.fields.get(field, original)
        for field in snapshot.fields:
            if field != "gravity" and field not in engine.originals:
                engine.touch(field)[:] = snapshot.fields[field]
        model.opt.gravity[:] = snapshot.fields["gravity"]
        if isinstance(snapshot.data, np.ndarray):
            mujoco.mj_setState(model, physics.data, snapshot.data, INTEGRATION_STATE)
        else:
            mujoco.mj_copyData(physics.data, model, snapshot.data)
        engine.loop.jump(snapshot.tick - physics.tick)
        physics.set_state(snapshot.physics, is_model_changed=bool(engine.originals))
        if with_inbox:
            self._commands.refill(snapshot.inbox)
        for part, state in snapshot.handles:
            part.set_state(state)
        for sensor, state in snapshot.sensors:
            sensor.set_state(state)
        for plugin, state in snapshot.plugins:
            engine.faults.take_back(plugin, state)
        engine.wrenches.push(are_applied=True)


class HashedSimulation(Protocol):
    """Interface of a simulation whose state is hashed."""

    @property
    def mj_data(self) -> mujoco.MjData:
        """MuJoCo's data."""

    @property
    def engine(self) -> Engine:
        """Engine, whose structure has the actors."""


def state_hash(sim: HashedSimulation) -> str:
    """Return the SHA-256 of the bits of positions and velocities, in hexadecimal.

    In a world with actors, the hash also covers their names, the poses of their links, and their animations. Actors
    have no positions or velocities in MuJoCo's state, because they follow a script.
    """
    digest = hashlib.sha256()
    data, structure = sim.mj_data, sim.engine.structure
    digest.update(data.qpos.tobytes())
    digest.update(data.qvel.tobytes())
    actors = [model for _, model in sorted(structure.models.items()) if model.moved_by is not None]
    for actor in actors:
        rows = [structure.compiled.names.link(link.scoped).mocap for link in actor.links]
        digest.update(actor.name.encode())
        digest.update(data.mocap_pos[rows].tobytes())
        digest.update(data.mocap_quat[rows].tobytes())
    for plugin in structure.all_plugins() if actors else ():
        if hasattr(plugin, "animation_state"):
            digest.update(repr(plugin.animation_state()).encode())
    return digest.hexdigest()
