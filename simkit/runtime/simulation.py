"""A running simulation: the one loop in the house."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import Any

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.errors import InputError, SimulationDiverged
from simkit.runtime.communication.communication import Communication
from simkit.runtime.communication.journal import journaled
from simkit.runtime.contact.anisotropic_friction import AnisotropicFriction
from simkit.runtime.contact.speculative_contacts import FastBodyWarnings
from simkit.runtime.engine.clock import Clock
from simkit.runtime.engine.engine_access import EngineAccess
from simkit.runtime.engine.external_forces import PersistentWrenches, Wind
from simkit.runtime.engine.physics import Physics
from simkit.runtime.engine.plugin_faults import PluginErrorPolicy, PluginFaults, add_driver_hints
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.runtime.engine.scheduler import Scheduler
from simkit.runtime.engine.snapshot import Snapshot, promise_snapshot, restore_snapshot, take_snapshot
from simkit.runtime.engine.step_loop import StepLoop, guarded_hook
from simkit.runtime.engine.step_tasks import fill_schedule
from simkit.runtime.engine.velocity_servos import VelocityServos
from simkit.runtime.engine.world_structure import WorldStructure
from simkit.runtime.handles.entity_handles import EntityHandles
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.visual_properties import Labels, Temperatures
from simkit.runtime.spawner import ModelLoader, SensorsAndPluginsMaker, Spawner
from simkit.runtime.world_contents import WorldContents
from simkit.runtime.world_control import WorldControl
from simkit.scene import SceneWorld


class Simulation(Communication, WorldControl, WorldContents, EngineAccess):
    """A loaded world. Made by `simkit.load`; also a context manager.

    Everything read shows the state at `time`.

    Attributes:
        labels: what segmentation and bounding box cameras call things, by scoped name of a model or a visual.
        temperatures: what thermal cameras see, by scoped name of a model, a link or a visual.
        wind: how the air moves.
        faults: what becomes of plugins that raise, and which of them are left out.
        render_thread: whether pictures of cameras are drawn beside the physics where nobody waits for them; to be
            changed at any time, for it changes no message.
        origin: how it was loaded: `simkit.load`'s arguments by name, and `folder`, where that was; None of what was
            made otherwise.
    """

    render_thread = False
    origin: Mapping[str, Any] | None = None

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
        self.world = world
        self.log = logging.getLogger("simkit")
        self.clock = Clock(world.physics.max_step_size)
        self._diagnostics = diagnostics
        self.open_interfaces(self)
        self.faults = PluginFaults(self, on_error)
        self.streams = RandomStreams(seed)
        self.seed = seed
        self.originals: dict[str, Any] = {}
        self._exact_limits: list[Joint] = []
        self._standing = PersistentWrenches(self)
        self.wind = Wind(world)
        self._closed = False
        self.open_world(self)
        self.physics = Physics(structure.compiled.model, structure.compiled.data, self.clock, world.physics.sleep)
        self._loop = StepLoop(self.physics, self.bus, self._fill)
        self.velocity_servos = VelocityServos(self)
        self.entities = EntityHandles(self, world)
        self.labels = Labels(self)
        self.temperatures = Temperatures(self)
        self.friction = AnisotropicFriction(self.physics, self.reports)
        self.fast_body_reports = FastBodyWarnings(self.reports, self.timestep)
        self._population = Spawner(self, load_model, make_parts)
        self._population.adopt(structure)
        self._population.start(list(structure.parts.values()), diagnostics)
        self.reschedule()
        self._loaded = self.snapshot()

    # ------------------------------------------------------------------ time

    @property
    def tick(self) -> int:
        """Steps done."""
        return self.physics.tick

    @property
    def steps(self) -> int:
        """Steps made since it was loaded, those among them that a reset or a restore has undone."""
        return self.physics.tick - self._loop.jumped

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.clock.time(self.physics.tick)

    @property
    def time_ns(self) -> int:
        """Simulated time [ns]."""
        return self.clock.time_ns(self.physics.tick)

    @property
    def timestep(self) -> float:
        """Length of a step [s]."""
        return self.clock.timestep

    @property
    def is_stepping(self) -> bool:
        """Whether a step is under way: this is asked by a hook or a callback."""
        return self._loop.is_running

    # ------------------------------------------------------------------ advancing

    def step(self, count: int = 1) -> None:
        """Advances `count` steps.

        Raises:
            SimulationDiverged: the physics left the numbers.
            PluginError: a plugin raised.
        """
        if count < 0:
            raise ValueError(f"count must not be negative, got {count}")
        self._advance(self.tick + int(count))

    def run(self, duration: float) -> None:
        """Advances a duration [s] of simulated time, to the nearest whole step.

        Where a hook goes back to an earlier time it goes on from there, for what is left of the duration.
        """
        if not duration >= 0:
            raise ValueError(f"duration must be a number of seconds that is not negative, got {duration}")
        self._advance(self.tick + self.clock.ticks(duration))

    def run_until(self, condition: Callable[[Simulation], bool], timeout: float) -> bool:
        """Steps until `condition(sim)`, asked after every step, holds; False when `timeout` [s] passed before."""
        for _ in range(self.clock.ticks(timeout)):
            self.step()
            if condition(self):
                return True
        return False

    def jump(self, ticks: int) -> None:
        """Told by a reset or a restore how much further, or back, it takes the run."""
        self._loop.jump(ticks)

    def _advance(self, target: int, *, is_served: bool = False) -> None:
        self._check_open()
        journal = self.bus.journal
        if journal is not None:
            journal.before_steps()
        try:
            self._loop.advance(target, is_served=is_served)
        except SimulationDiverged as error:
            add_driver_hints(self, error)
            raise
        finally:
            if journal is not None:
                journal.after_steps()

    # ------------------------------------------------------------------ state

    @journaled
    def reset(self, seed: int | None = None) -> None:
        """Back to t = 0 and to what was loaded: physics, plugins, sensors, random streams (optionally re-seeded)."""
        self._check_loaded()
        if seed is not None:
            self.seed = seed
        self._loop.break_promises()
        self.bus.settle()
        self.streams.reseed(self.seed)
        restore_snapshot(self, self._loaded)
        self.halt()  # a run that is served looks anew at how far it is to go
        self.reschedule()
        self.forget_gone()
        for sensor in self.structure.all_sensors():
            sensor.reset()
        for plugin in self.structure.all_plugins():
            guarded_hook(self, plugin, "reset")()

    @journaled
    def snapshot(self) -> Snapshot:
        """The whole state; a run restored to it repeats bit for bit.

        Asked for by a hook or a callback it is that of the end of the step under way, and complete from then on.
        """
        self._check_open()
        if not self.is_stepping:
            return take_snapshot(self)
        snapshot, keep = promise_snapshot(self)
        self._loop.promise(keep)
        return snapshot

    @journaled
    def restore(self, snapshot: Snapshot) -> None:
        """Back (or forward) to a snapshot of this simulation; what was spawned or removed since is undone.

        Raises:
            ValueError: the snapshot is of another simulation, or was asked for within a step that has not ended.
        """
        self._check_open()
        if snapshot.owner is not self:
            raise ValueError("the snapshot is of another simulation; each goes back to its own only")
        if not snapshot.is_complete:
            raise ValueError("the snapshot was asked for within a step that has not ended; restore it after that step")
        self._loop.break_promises()
        if snapshot.seed != self.seed:
            self.bus.settle()
            self.seed = snapshot.seed
            self.streams.reseed(self.seed)
        restore_snapshot(self, snapshot)
        self.halt()
        self.reschedule()
        self.forget_gone()

    # ------------------------------------------------------------------ what was found

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What loading approximated or ignored."""
        return list(self._diagnostics)

    @property
    def reports(self) -> Diagnostics:
        """The collection behind `diagnostics`, for parts that have something to report while running."""
        return self._diagnostics

    # ------------------------------------------------------------------ schedule

    @property
    def scheduler(self) -> Scheduler:
        """Who is due when."""
        return self._loop.scheduler

    def reschedule(self) -> None:
        """Takes changed rates, sensors and plugins into account; within a hook, once the tick is dealt with."""
        self._loop.reschedule()

    def _fill(self, scheduler: Scheduler) -> None:
        fill_schedule(self, scheduler, self._exact_limits)

    def limit_velocity(self, joint: Joint) -> None:
        """Holds a joint's velocity limit at every step from now on."""
        if joint not in self._exact_limits:
            self._exact_limits.append(joint)
        self.reschedule()

    # ------------------------------------------------------------------ the end

    def close(self) -> None:
        """Closes plugins and sensors; further calls do nothing."""
        if self._closed:
            return
        first = self._population.close_plugins()
        for sensor in self.structure.all_sensors():
            sensor.close()
        self._closed = True
        if first is not None:
            raise first

    def _check_open(self) -> None:
        if self._closed:
            raise InputError("the simulation is closed", "SK-CORE-002")

    def _check_loaded(self) -> None:
        self._check_open()
        if "_loaded" not in vars(self):
            raise InputError("the world is still being loaded, there is nothing yet to go back to", "SK-CORE-004")

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __deepcopy__(self, memo: Mapping[int, Any]) -> Simulation:
        return self
