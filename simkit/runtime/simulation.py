"""Running simulation: the object that users step, read and command."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final, cast

from simkit.argument_checks import check_function, check_kind, checked_seed
from simkit.errors import InputError, SimulationDiverged
from simkit.in_process import InProcess
from simkit.memory_error import find_memory_error
from simkit.pose import Pose, Vector
from simkit.run_spec import PluginErrorPolicy, RunSpec
from simkit.runtime.communication.communication import Communication
from simkit.runtime.communication.journal import journaled
from simkit.runtime.communication.large_commands import forget_commands, large_commands
from simkit.runtime.communication.script_graph import ScriptGraph
from simkit.runtime.communication.topic_bus import TopicBus
from simkit.runtime.contact.collision_contacts import Contact, list_contacts
from simkit.runtime.engine.engine import Engine
from simkit.runtime.engine.plugin_faults import add_driver_hints
from simkit.runtime.engine.simulated_time import Clock
from simkit.runtime.engine.snapshot import Snapshot, Stateful
from simkit.runtime.engine.step_tasks import fill_schedule
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.light import Light
from simkit.runtime.handles.link import Link
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.visual import Visual
from simkit.runtime.portable_snapshot import PortableSnapshot, pack_snapshot, unpack_snapshot
from simkit.runtime.spawner import ModelLoader, SensorsAndPluginsMaker
from simkit.runtime.world_contents import WorldContents
from simkit.runtime.world_control import Page, WorldControl

if TYPE_CHECKING:
    import mujoco

    from simkit.diagnostics import Diagnostic, Diagnostics
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.scheduler import Scheduler
    from simkit.scene import SceneWorld


_ASYNC_SLICE: Final = 0.02  # [s] wall time in which `run_async` does not return to the event loop


class Simulation(ScriptGraph, InProcess):
    """Loaded world, made by `simkit.load`; also a context manager.

    All readings show the state at `time`.

    Attributes:
        engine: physics, step loop, servos, random streams, plugin faults.
        communication: topics, services, actions and live parameters.
        contents: models, links, joints, sensors and plugins, with functions to add and remove them.
        control: pause, gravity, collisions, geographic origin, reset of models.
        run_spec: specification of the run from `simkit.load`; None for a simulation made in another way.
    """

    run_spec: RunSpec | None = None
    _open_page: Callable[[Simulation, int], Page] | None = None
    _page: Page | None = None

    def __init__(
        self,
        world: SceneWorld,
        structure: WorldStructure,
        diagnostics: Diagnostics,
        seed: int,
        load_model: ModelLoader,
        make_parts: SensorsAndPluginsMaker,
        on_error: PluginErrorPolicy | None = None,
    ) -> None:
        clock = Clock(world.physics.max_step_size)
        self._bus = bus = TopicBus(diagnostics, lambda: self.time)
        self.engine = Engine(world, structure, clock, seed, diagnostics, bus, self._fill, on_error)
        self.communication = Communication(bus, self.engine)
        self.engine.faults.interfaces = self.communication
        self.contents = WorldContents(self, self.engine, self.communication, self._stateful, load_model, make_parts)
        self._snapshots = self.contents.spawner.snapshots
        self._snapshots.pack = partial(pack_snapshot, self)
        self.control = WorldControl(self.engine, bus, self.contents.handles, self._advance, self._loaded_state)
        self.contents.spawner.adopt(structure)
        self.contents.spawner.start(list(structure.parts.values()), diagnostics)
        self.engine.reschedule()
        self._loaded = self.snapshot()

    @property
    def tick(self) -> int:
        """Number of steps from t = 0 to the present state."""
        return self.engine.physics.tick

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.engine.time

    @property
    def time_ns(self) -> int:
        """Simulated time [ns]."""
        return self.engine.time_ns

    @property
    def seed(self) -> int:
        """Seed of all random streams."""
        return self.engine.streams.seed

    @property
    def timestep(self) -> float:
        """Length of a step [s]."""
        return self.engine.clock.timestep

    def step(self, count: int = 1) -> None:
        """Advance by `count` steps. Raise SimulationDiverged or PluginError if the physics or a plugin fails."""
        self._advance(self.tick + self.engine.clock.checked_count(count))

    def run(self, duration: float) -> None:
        """Advance by a duration [s] of simulated time, rounded to the nearest whole step.

        If a hook restores an earlier time, the number of steps stays the same.
        """
        self._advance(self.tick + self.engine.clock.checked_ticks(duration, "duration"))

    async def run_async(self, duration: float) -> None:
        """Advance like `run`; between short slices of wall time, other tasks of the event loop continue."""
        from asyncio import sleep

        engine, slice_ = self.engine, 1
        end = engine.steps + engine.clock.checked_ticks(duration, "duration")
        while engine.steps < end:
            begun = time.perf_counter()
            slice_ = min(slice_, end - engine.steps)
            self._advance(self.tick + slice_)
            share = _ASYNC_SLICE / max(time.perf_counter() - begun, 1e-6)
            slice_ = max(1, int(slice_ * min(share, 2.0)))
            await sleep(0)

    def run_until(self, condition: Callable[[Simulation], bool], timeout: float) -> bool:
        """Step until `condition(sim)` holds after a step; return False if `timeout` [s] passed first."""
        check_function(condition, "condition")
        self.engine.check_open()
        for _ in range(self.engine.clock.checked_ticks(timeout, "timeout")):
            self.step()
            if condition(self):
                return True
        return False

    def _advance(self, target: int, *, is_served: bool = False) -> None:
        self.engine.check_open()
        self.communication.log_topic.use_thread()
        journal = self._bus.journal
        if journal is not None:
            journal.before_steps()
        try:
            if self._page is None or is_served:
                self.engine.loop.advance(target, is_served=is_served)
            else:
                self._page.advance(target, self.engine.loop.advance)
        except SimulationDiverged as error:
            add_driver_hints(self.engine.structure.all_plugins(), error, large_commands(self._bus))
            raise
        except Exception as error:
            if too_little := find_memory_error(error):
                raise too_little from error
            raise
        finally:
            if journal is not None:
                journal.after_steps()

    def reset(self, seed: int | None = None, *, keep_changes: bool = False) -> None:
        """Reset physics, plugins, sensors and random streams to the loaded state at t = 0.

        Args:
            seed: new seed of all random streams; None keeps the present one.
            keep_changes: True to keep masses, friction, joint dynamics, gains, noise, lights and gravity that were set.
        """
        check_kind(keep_changes, bool, "keep_changes", "True or False")
        changes, gravity = self.engine.numbers.values, self.gravity
        self._reset(seed)
        if keep_changes:
            self.gravity = gravity
            self.contents.handles.set_values(changes)

    @journaled
    def _reset(self, seed: int | None = None) -> None:
        loaded, engine = self._loaded_state(), self.engine
        seed = engine.streams.seed if seed is None else checked_seed(seed)
        engine.loop.drop_deferred()
        self.communication.bus.settle()
        forget_commands(self._bus)
        engine.streams.reseed(seed)
        self._restore(loaded)
        for sensor in engine.structure.all_sensors():
            sensor.reset()
        for plugin in engine.structure.all_plugins():
            if plugin.has_hook("reset"):
                engine.faults.task(plugin, "reset")(0)

    @journaled
    def snapshot(self) -> Snapshot:
        """Return the whole state; a run that is restored to it repeats bit for bit.

        If a hook or a callback requests a snapshot, the state is stored in the snapshot at the end of the present step.
        Use this snapshot only after the step.
        """
        self.engine.check_open()
        if not self.engine.is_stepping:
            return self._snapshots.take()
        snapshot, keep = self._snapshots.defer()
        self.engine.loop.defer(keep)
        return snapshot

    @journaled
    def restore(self, snapshot: Snapshot | PortableSnapshot) -> None:
        """Restore a snapshot of this simulation, earlier or later; spawns and removals since then are undone.

        Args:
            snapshot: result of `snapshot()`, or a pickled snapshot of a simulation with an equal `run_spec`.

        Raises:
            ValueError: the snapshot belongs to another simulation, or its step has not ended.
        """
        engine = self.engine
        engine.check_open()
        if isinstance(snapshot, PortableSnapshot):
            snapshot = unpack_snapshot(self, snapshot)
        self._snapshots.check(snapshot)
        engine.loop.drop_deferred()
        if snapshot.seed != engine.streams.seed:
            self.communication.bus.settle()
            engine.streams.reseed(snapshot.seed)
        self._restore(snapshot)

    def _restore(self, snapshot: Snapshot) -> None:
        self._snapshots.restore(snapshot)
        self.engine.loop.halt()  # `simkit run` then computes its target again
        self.engine.reschedule()
        self.contents.spawner.forget_gone()

    def _stateful(self) -> list[Stateful]:
        """Return every part with a state, except sensors and plugins, in the order of restoring."""
        engine, interfaces, control, handles = self.engine, self.communication, self.control, self.contents.handles
        own = (engine.faults, *interfaces.stateful(), control.pausing, control.origin)
        return [*handles.stateful(), *own, engine.numbers, engine.velocity_servos, *handles.tables["model"].values()]

    def _loaded_state(self) -> Snapshot:
        self.engine.check_open()
        if "_loaded" not in vars(self):
            raise InputError("the world is still being loaded, so there is no state to reset to", "SK-CORE-004")
        return self._loaded

    @property
    def world(self) -> SceneWorld:
        """World as the file describes it."""
        return self.engine.world

    @property
    def models(self) -> dict[str, Model]:
        """Top-level models by name."""
        self.engine.check_open()
        return self.contents.models

    def model(self, name: str) -> Model:
        """Return a model by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.model(name)

    def link(self, name: str) -> Link:
        """Return a link by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.link(name)

    def joint(self, name: str) -> Joint:
        """Return a joint by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.joint(name)

    def sensor(self, name: str) -> Any:
        """Return a sensor by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.find("sensor", name)

    def light(self, name: str) -> Light:
        """Return a light by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.light(name)

    def visual(self, name: str) -> Visual:
        """Return a visual by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.find_visual(name)

    def contacts(self, model: Model | str | None = None) -> list[Contact]:
        """Return the contacts of a model, also with itself, or of all; a KeyError suggests the closest name."""
        name = None if model is None else self.model(cast("str", getattr(model, "scoped", model))).scoped
        return list_contacts(self.engine.compiled, self.engine.physics.awake_data(), name)

    def spawn(self, source: object, name: str | None = None, pose: Pose | None = None) -> Model:
        """Add a model during the run; everything else keeps its state and its handles.

        Args:
            source: file, URI such as `model://tiago`, XML text, or bare name of a model.
            name: name of the model; None for the name in the file.
            pose: pose of the model frame in the world; None for the pose in the file.

        Raises:
            LoadError: the source has errors, or the name is already used.
            InputError: no model can have this name.
        """
        return self.contents.spawn_all([(source, name, pose)])[0]

    def remove(self, name: str) -> None:
        """Remove a top-level model during the run."""
        self.contents.remove(name)

    @property
    def gravity(self) -> Vector:
        """Gravity [m/s²], world frame, shape (3,); settable at any time."""
        return self.control.gravity

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        self.control.gravity = value

    @property
    def plugins(self) -> dict[str, Any]:
        """Plugins of the file by scoped name."""
        self.engine.check_open()
        return self.contents.plugins

    @property
    def paused(self) -> bool:
        """True while the world is paused; settable. A pause does not stop a script that calls `step` or `run`."""
        return self.control.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.control.paused = paused

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings and notes of the load: approximated or ignored parts of the input."""
        return list(self.engine.reports)

    @property
    def mj_model(self) -> mujoco.MjModel:
        """MuJoCo's `MjModel`; a new object after a spawn or a removal."""
        return self.engine.physics.model

    @property
    def mj_data(self) -> mujoco.MjData:
        """MuJoCo's `MjData`; a new object after a spawn or a removal."""
        return self.engine.physics.data

    def _fill(self, scheduler: Scheduler) -> None:
        handles = self.contents.handles
        fill_schedule(self.engine, scheduler, handles.tables["joint"].values(), handles.exact_limits)
        self.communication.on_demand.fill(scheduler)

    def view(self, port: int = 0) -> str:
        """Show the simulation in a browser; `step` and `run` then update the page.

        Args:
            port: port of the page on this machine; 0 for a free one. Only the first call uses it.

        Returns:
            Address of the page. A notebook shows the page itself.
        """
        self.engine.check_open()
        if self._page is None:
            if self._open_page is None:
                raise InputError("only simulations from simkit.load have a view", "SK-WEB-006")
            self._page = self._open_page(self, port)
        return self._page.address

    def close(self) -> None:
        """Close plugins and sensors; further calls do nothing."""
        engine = self.engine
        if engine.is_closed:
            return
        if self._page is not None:
            self._page.close()
        first = self.contents.spawner.close_plugins()
        for sensor in engine.structure.all_sensors():
            sensor.close()
        self.contents.handles.close()
        engine.is_closed = True
        if first is not None:
            raise first

    def __repr__(self) -> str:
        if "_loaded" not in vars(self):
            return "<Simulation (being loaded)>"
        plural = "" if len(self.contents.models) == 1 else "s"
        state = "closed" if self.engine.is_closed else f"t={self.time:g} s, {len(self.contents.models)} model{plural}"
        return f"<Simulation {self.world.name!r}: {state}>"

    def __enter__(self) -> Simulation:
        self.engine.check_open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
