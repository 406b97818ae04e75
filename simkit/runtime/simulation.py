"""A running simulation: the one loop in the house."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import Any

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.errors import InputError, SimulationDiverged
from simkit.runtime.clock import Clock
from simkit.runtime.contents import Contents
from simkit.runtime.directed_friction import DirectedFriction
from simkit.runtime.divergence import name_drivers
from simkit.runtime.doors import door
from simkit.runtime.engine_access import EngineAccess
from simkit.runtime.entities import Entities
from simkit.runtime.fast_body_reports import FastBodyReports
from simkit.runtime.faults import Faults, OnError
from simkit.runtime.interfaces import Interfaces
from simkit.runtime.joint import Joint
from simkit.runtime.labels import Labels
from simkit.runtime.loop import Loop, guarded
from simkit.runtime.parts import Structure
from simkit.runtime.physics import Physics
from simkit.runtime.population import ModelLoader, PartsMaker, Population
from simkit.runtime.random import RandomStreams
from simkit.runtime.schedule import fill
from simkit.runtime.scheduler import Scheduler
from simkit.runtime.snapshot import Snapshot, bring_back, promise, take
from simkit.runtime.temperatures import Temperatures
from simkit.runtime.velocity_servos import VelocityServos
from simkit.runtime.wind import Wind
from simkit.runtime.world_control import WorldControl
from simkit.runtime.wrenches import StandingWrenches
from simkit.scene import SceneWorld


class Simulation(Interfaces, WorldControl, Contents, EngineAccess):
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
        structure: Structure,
        diagnostics: Diagnostics,
        seed: int,
        load_model: ModelLoader,
        make_parts: PartsMaker,
        on_error: OnError | None = None,
    ) -> None:
        self.world = world
        self.log = logging.getLogger("simkit")
        self.clock = Clock(world.physics.max_step_size)
        self._diagnostics = diagnostics
        self.open_interfaces(self)
        self.faults = Faults(self, on_error)
        self.streams = RandomStreams(seed)
        self.seed = seed
        self.originals: dict[str, Any] = {}
        self._exact_limits: list[Joint] = []
        self._standing = StandingWrenches(self)
        self.wind = Wind(world)
        self._closed = False
        self.open_world(self)
        self.physics = Physics(structure.compiled.model, structure.compiled.data, self.clock, world.physics.sleep)
        self._loop = Loop(self.physics, self.bus, self._fill)
        self.velocity_servos = VelocityServos(self)
        self.entities = Entities(self, world)
        self.labels = Labels(self)
        self.temperatures = Temperatures(self)
        self.friction = DirectedFriction(self)
        self.fast_body_reports = FastBodyReports(self)
        self._population = Population(self, load_model, make_parts)
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
            name_drivers(self, error)
            raise
        finally:
            if journal is not None:
                journal.after_steps()

    # ------------------------------------------------------------------ state

    @door
    def reset(self, seed: int | None = None) -> None:
        """Back to t = 0 and to what was loaded: physics, plugins, sensors, random streams (optionally re-seeded)."""
        self._check_loaded()
        if seed is not None:
            self.seed = seed
        self._loop.break_promises()
        self.bus.settle()
        self.streams.reseed(self.seed)
        bring_back(self, self._loaded)
        self.halt()  # a run that is served looks anew at how far it is to go
        self.reschedule()
        self.forget_gone()
        for sensor in self.structure.all_sensors():
            sensor.reset()
        for plugin in self.structure.all_plugins():
            guarded(self, plugin, "reset")()

    @door
    def snapshot(self) -> Snapshot:
        """The whole state; a run restored to it repeats bit for bit.

        Asked for by a hook or a callback it is that of the end of the step under way, and complete from then on.
        """
        self._check_open()
        if not self.is_stepping:
            return take(self)
        snapshot, keep = promise(self)
        self._loop.promise(keep)
        return snapshot

    @door
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
        bring_back(self, snapshot)
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
        fill(self, scheduler, self._exact_limits)

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
