"""A running simulation: the one loop in the house."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.errors import InputError, SimulationDiverged
from simkit.pose import IDENTITY, Pose, Vector
from simkit.runtime.clock import Clock
from simkit.runtime.divergence import name_drivers
from simkit.runtime.entities import Entities, place_light
from simkit.runtime.faults import Faults, OnError
from simkit.runtime.interfaces import Interfaces
from simkit.runtime.joint import Joint
from simkit.runtime.labels import Labels
from simkit.runtime.light import Light
from simkit.runtime.link import Link
from simkit.runtime.loop import Loop, guarded
from simkit.runtime.model import Model
from simkit.runtime.overlap import soften
from simkit.runtime.parts import Structure
from simkit.runtime.physics import CONTROL, HeldState, Physics
from simkit.runtime.population import ModelLoader, PartsMaker, Population
from simkit.runtime.random import RandomStreams
from simkit.runtime.schedule import fill
from simkit.runtime.scheduler import Scheduler
from simkit.runtime.snapshot import Snapshot, bring_back, promise, take
from simkit.runtime.temperatures import Temperatures
from simkit.runtime.visual import Visual
from simkit.runtime.weld import set_weld
from simkit.runtime.world_control import WorldControl
from simkit.runtime.wrenches import StandingWrenches
from simkit.scene import SceneLink, SceneWorld


class Simulation(Interfaces, WorldControl):
    """A loaded world. Made by `simkit.load`; also a context manager.

    Everything read shows the state at `time`.

    Attributes:
        labels: what segmentation and bounding box cameras call things, by scoped name of a model or a visual.
        temperatures: what thermal cameras see, by scoped name of a model, a link or a visual.
        faults: what becomes of plugins that raise, and which of them are left out.
        render_thread: whether pictures of cameras are drawn beside the physics where nobody waits for them; to be
            changed at any time, for it changes no message.
    """

    render_thread = False

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
        self._closed = False
        self.open_world(self)
        self.physics = Physics(structure.compiled.model, structure.compiled.data, self.clock, world.physics.sleep)
        self._loop = Loop(self.physics, self.bus, self._fill)
        self.entities = Entities(self, world)
        self.labels = Labels(self)
        self.temperatures = Temperatures(self)
        self._population = Population(self, load_model, make_parts)
        self._population.adopt(structure)
        self._population.start(list(structure.parts.values()), diagnostics)
        soften(self)
        self.reschedule()
        self._loaded = self.snapshot()

    # ------------------------------------------------------------------ time

    @property
    def tick(self) -> int:
        """Steps done."""
        return self.physics.tick

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
        """Advances a duration [s] of simulated time, to the nearest whole step."""
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

    def _advance(self, target: int, *, is_served: bool = False) -> None:
        self._check_open()
        try:
            self._loop.advance(target, is_served=is_served)
        except SimulationDiverged as error:
            name_drivers(self, error)
            raise

    # ------------------------------------------------------------------ state

    def reset(self, seed: int | None = None) -> None:
        """Back to t = 0 and to what was loaded: physics, plugins, sensors, random streams (optionally re-seeded)."""
        self._check_open()
        if seed is not None:
            self.seed = seed
        self._loop.break_promises()
        self.bus.settle()
        self.streams.reseed(self.seed)
        bring_back(self, self._loaded)
        self.reschedule()
        self._forget()
        for sensor in self.structure.all_sensors():
            sensor.reset()
        for plugin in self.structure.all_plugins():
            guarded(self, plugin, "reset")()

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
        self.reschedule()
        self._forget()

    def adopt(self, structure: Structure) -> None:
        """Goes on with a structure that was before, with all its state still to be put back."""
        self._population.adopt(structure)

    # ------------------------------------------------------------------ what is in it

    @property
    def models(self) -> dict[str, Model]:
        """Top-level models by name."""
        return dict(self.entities.models)

    @property
    def lights(self) -> dict[str, Light]:
        """Lights by scoped name."""
        return dict(self.entities.tables["light"])

    @property
    def sensors(self) -> dict[str, Any]:
        """Sensors by scoped name."""
        return dict(self.entities.tables["sensor"])

    def model(self, name: str) -> Model:
        """A model by scoped name; KeyError names the closest."""
        found: Model = self.entities.find("model", name)
        return found

    def link(self, name: str) -> Link:
        """A link by scoped name; KeyError names the closest."""
        found: Link = self.entities.find("link", name)
        return found

    def visual(self, name: str) -> Visual:
        """A visual by scoped name; KeyError names the closest."""
        return self.entities.find_visual(name)

    def joint(self, name: str) -> Joint:
        """A joint by scoped name; KeyError names the closest."""
        found: Joint = self.entities.find("joint", name)
        return found

    def sensor(self, name: str) -> Any:
        """A sensor by scoped name; KeyError names the closest."""
        return self.entities.find("sensor", name)

    def light(self, name: str) -> Light:
        """A light by scoped name; KeyError names the closest."""
        found: Light = self.entities.find("light", name)
        return found

    @property
    def plugins(self) -> dict[str, Any]:
        """Plugins by scoped name, `robot::drive`; those of the world by their own. Of equal names the first."""
        found: dict[str, Any] = {}
        for plugin in self.structure.all_plugins():
            found.setdefault(f"{plugin.scoped}::{plugin.name}" if plugin.scoped else plugin.name, plugin)
        return found

    def has_sensor(self, name: str) -> bool:
        """Whether a sensor of that name is simulated."""
        return name in self.entities.tables["sensor"]

    def scene_link(self, scoped: str) -> SceneLink:
        """A link as the file has it."""
        return self.entities.scene_link(scoped)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What loading approximated or ignored."""
        return list(self._diagnostics)

    @property
    def reports(self) -> Diagnostics:
        """The collection behind `diagnostics`, for parts that have something to report while running."""
        return self._diagnostics

    # ------------------------------------------------------------------ the world's own

    @property
    def gravity(self) -> Vector:
        """Acceleration that everything feels [m/s²], world frame, shape (3,); settable at any time."""
        return np.array(self.mj_model.opt.gravity)

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        numbers = np.asarray(value, dtype=float)
        if numbers.shape != (3,) or not np.isfinite(numbers).all():
            raise ValueError(f"gravity takes 3 finite numbers, got {value}")
        for sensor in self.structure.all_sensors():
            sensor.take_held()  # what was held was measured under the old one
        self.physics.changed_model()
        self.mj_model.opt.gravity[:] = numbers

    # ------------------------------------------------------------------ the engine underneath

    @property
    def mj_model(self) -> Any:
        """The `mujoco.MjModel`; a new object after a spawn or a removal."""
        return self.physics.model

    @property
    def mj_data(self) -> Any:
        """The `mujoco.MjData`; a new object after a spawn or a removal."""
        return self.physics.data

    @property
    def names(self) -> Any:
        """The compiler's name map of the present model."""
        return self.structure.compiled.names

    @property
    def structure(self) -> Structure:
        """What is in the world now."""
        return self._population.structure

    @property
    def compiled(self) -> Any:
        """What the compiler made of the present structure."""
        return self.structure.compiled

    def fresh_data(self) -> Any:
        """`mj_data` with everything computed for the state at `time`."""
        return self.physics.fresh()

    def fresh_acceleration(self) -> Any:
        """The same with body accelerations and interaction forces."""
        return self.physics.fresh_accelerations()

    def hold_state(self) -> HeldState:
        """The physics state of this tick, to be measured later."""
        return self.physics.hold()

    def data_of(self, held: HeldState) -> Any:
        """An `MjData` of a held state with everything computed."""
        return self.physics.data_of(held)

    def set_control(self, actuator: Any, value: float) -> None:
        """Writes the control of an actuator that a plugin added; the next step sees it.

        A velocity is kept within the joint's velocity limit.
        """
        if actuator.kind == "velocity":
            limit = float(self.joint(actuator.joint)._velocity_limit[actuator.axis])
            value = max(-limit, min(limit, value))
        self.mj_data.ctrl[self.names.actuator(actuator)] = value
        self.physics.changed(CONTROL)

    def touch(self, field: str) -> Any:
        """A model field to be written to; snapshots and restores cover it from now on."""
        values = getattr(self.mj_model, field)
        if not field.startswith("light_"):
            for sensor in self.structure.all_sensors():
                sensor.take_held()
            self.physics.changed_model()
        if field not in self.originals:
            self.originals[field] = values.copy()
        return values

    def original(self, field: str) -> Any:
        """A touched field's values as compiled."""
        return self.originals[field]

    # ------------------------------------------------------------------ spawn and remove

    def spawn(self, source: Any, name: str | None = None, pose: Pose | None = None) -> Model:
        """Adds a model while time goes on; everything else keeps its state and its handles.

        Args:
            source: a file, XML text, or the bare name of a model.
            name: instead of the file's own.
            pose: of the model frame in the world, instead of the file's own.

        Raises:
            LoadError: the source has errors, or the name is taken.
        """
        self._check_open()
        name = self._population.spawn(source, name, pose)
        self.reschedule()
        return self.model(name)

    def remove(self, name: str) -> None:
        """Takes a top-level model away while time goes on."""
        self._check_open()
        self.model(name)  # an unknown name is a KeyError that tells the closest
        self._population.remove(name)
        self.reschedule()
        self._forget()

    def add_sensor(self, name: str, sensor: str | Mapping[str, Any]) -> Any:
        """Fits a sensor to a link or a joint while time goes on; nobody else's bits change.

        Snapshots, resets and removals cover it: it goes with its model, and a reset or a restore to an earlier time
        takes it away.

        Args:
            name: scoped name of the link or joint.
            sensor: a `<sensor>` element as XML text, or a dict of it: `{"name": "imu", "type": "imu",
                "update_rate": 100, "imu": {…}}`.

        Returns:
            The sensor.

        Raises:
            LoadError: the sensor has errors.
            KeyError: there is no such link or joint; names the closest.
            InputError: it has a sensor of that name.
        """
        self._check_open()
        scoped = self._population.add_sensor(name, sensor)
        self.reschedule()
        return self.sensor(scoped)

    def _forget(self) -> None:
        """Closes what nothing brings back any more; within a step once that is done, for it may be at work."""
        if self.is_stepping:
            self._loop.promise(self._population.forget)
        else:
            self._population.forget()

    def make_movable(self, name: str) -> None:
        """Lets a static top-level model be moved: its links become bodies that follow their set pose."""
        if self._population.make_movable(name):
            self.reschedule()

    def add_weld(self, name: str, parent_link: str, child_link: str) -> None:
        """Adds a weld between two links while time goes on; `set_weld` closes it. Raises KeyError for unknown links."""
        self._population.add_weld(name, parent_link, child_link)
        self.reschedule()

    def set_weld(self, name: str, closed: bool) -> None:
        """Closes a weld with its links as they stand now, or lets it go. Raises KeyError."""
        set_weld(self, name, closed)

    def set_standing_wrenches(self, owner: str, wrenches: Mapping[str, Any], *, are_applied: bool = False) -> None:
        """Wrenches (force [N], torque [N·m], world frame, at the centre of mass) by link that hold until set anew.

        Args:
            owner: who sets them; what others set holds too.
            wrenches: by scoped link name; a link that is not there is waited for.
            are_applied: the state has them already (it was restored).
        """
        self._standing.set(owner, wrenches, are_applied=are_applied)

    def stand_wrenches(self, are_applied: bool = False) -> None:
        """Lets the standing wrenches push the links that are there now."""
        self._standing.push(are_applied=are_applied)

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

    def place_light(self, light: Light) -> None:
        """Shows a light where its handle says."""
        carrier = self.names.links.get(light.scene.link)
        place_light(self.mj_model, light, carrier.offset if carrier else IDENTITY, self.touch)
        self.physics.changed_lights()

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

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __deepcopy__(self, memo: Mapping[int, Any]) -> Simulation:
        return self
