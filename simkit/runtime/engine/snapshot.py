"""The whole state of a simulation at one tick: take it, restore it, hash it."""

from __future__ import annotations

import copy
import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco

from simkit.runtime.engine.physics_state import STALE, StepWindow
from simkit.runtime.engine.world_structure import WorldStructure
from simkit.runtime.handles.entity_handles import restore_compiled_fields
from simkit.runtime.handles.model import Model

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation


@dataclass(frozen=True)
class Snapshot:
    """What `restore` brings back; made by `Simulation.snapshot`.

    One that a hook or a callback asks for is of the end of the step under way: what else is due at its tick belongs to
    it, or a run restored to it would not repeat. Until then it has only its owner.

    Attributes:
        tick: where the run stood.
        structure: what was in the world.
        owner: the simulation that it is of.
    """

    tick: int
    structure: WorldStructure
    data: mujoco.MjData
    fields: dict[str, Any]
    sensors: list[tuple[Any, Any]]
    plugins: list[tuple[Any, Any]]
    handles: list[tuple[Any, Any]]
    inbox: tuple[tuple[str, Any], ...]
    one_shot: bool
    last_applied: Any
    window: StepWindow
    sleep: tuple[Any, ...] = (False,)
    last_pushed: Any = None
    seed: int = 0
    owner: Any = None

    @property
    def is_complete(self) -> bool:
        """Whether it can be restored: the step that it was asked for in has ended."""
        return "data" in vars(self)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"a snapshot has no {name!r} before the step in which it was asked for has ended")

    def __deepcopy__(self, memo: dict[int, Any]) -> Snapshot:
        return self


def promise_snapshot(sim: Simulation) -> tuple[Snapshot, Callable[[], None]]:
    """A snapshot that is still to be taken, and what takes it."""
    promised: Snapshot = object.__new__(Snapshot)
    vars(promised)["owner"] = sim
    return promised, lambda: vars(promised).update(vars(take_snapshot(sim)))


def take_snapshot(sim: Simulation) -> Snapshot:
    """The state of a simulation as it is now."""
    model, structure, physics = sim.mj_model, sim.structure, sim.physics
    plugins = [(p, sim.faults.state_of(p)) for p in structure.all_plugins()]  # first: it may leave one out
    data = copy.copy(sim.mj_data)
    fields = {f: getattr(model, f).copy() for f in sim.originals}
    fields["gravity"] = model.opt.gravity.copy()
    return Snapshot(
        tick=sim.tick,
        structure=structure,
        data=data,
        fields=fields,
        sensors=[(s, s.get_state()) for s in structure.all_sensors()],
        plugins=plugins,
        handles=[(h, h.get_state()) for h in sim.entities.stateful()]
        + [(part, part.get_state()) for part in (sim.faults, sim.parameter_table, sim.action_table)]
        + [(part, part.get_state()) for part in (sim.pausing, sim.site, sim.velocity_servos)]
        + [(m, m._rest) for m in sim.entities.tables["model"].values()],
        inbox=tuple(sim.bus.inbox.values()),
        one_shot=physics.one_shot,
        last_applied=physics.last_applied.copy(),
        sleep=physics.sleep.get_state(),
        last_pushed=physics.last_pushed.copy(),
        window=physics.window,
        seed=sim.seed,
        owner=sim,
    )


def restore_snapshot(sim: Simulation, snapshot: Snapshot, *, with_inbox: bool = True) -> None:
    """Puts a simulation into the state of a snapshot; its schedule is the caller's to make anew.

    Args:
        sim: the simulation.
        snapshot: of it.
        with_inbox: whether what waits for the next step goes back too; without it, what goes back is only a change
            that failed, and time goes on.
    """
    if snapshot.structure is not sim.structure:
        left, originals = sim.mj_model, dict(sim.originals)
        for sensor in sim.structure.all_sensors() if originals else ():
            sensor.take_held()
        sim.originals.clear()
        sim.adopt(snapshot.structure)
        restore_compiled_fields(left, originals)
    model, physics = sim.mj_model, sim.physics
    for field, original in sim.originals.items():
        getattr(model, field)[:] = snapshot.fields.get(field, original)
    for field in snapshot.fields:
        if field != "gravity" and field not in sim.originals:
            sim.touch(field)[:] = snapshot.fields[field]
    model.opt.gravity[:] = snapshot.fields["gravity"]
    mujoco.mj_copyData(sim.mj_data, model, snapshot.data)
    sim.jump(snapshot.tick - physics.tick)
    physics.tick = snapshot.tick
    physics.changed(STALE)
    if sim.originals:
        physics.changed_model()
    physics.clear_warnings()
    physics.one_shot = snapshot.one_shot
    physics.last_applied = snapshot.last_applied.copy()
    physics.last_pushed = snapshot.last_pushed.copy()
    physics.shows_applied = True
    physics.window = snapshot.window
    physics.sleep.set_state(snapshot.sleep)
    if with_inbox:
        sim.bus.inbox.refill(snapshot.inbox)
    for handle, state in snapshot.handles:
        if isinstance(handle, Model):
            handle._rest = state
        else:
            handle.set_state(state)
    for sensor, state in snapshot.sensors:
        sensor.set_state(state)
    for plugin, state in snapshot.plugins:
        sim.faults.take_back(plugin, state)
    sim.stand_wrenches(are_applied=True)


def state_hash(sim: Any) -> str:
    """SHA-256 of positions and velocities, as bits, in hexadecimal."""
    digest = hashlib.sha256()
    digest.update(sim.mj_data.qpos.tobytes())
    digest.update(sim.mj_data.qvel.tobytes())
    return digest.hexdigest()
