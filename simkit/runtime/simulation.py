"""A running simulation: the one loop in the house."""

from __future__ import annotations

import copy
import logging
from collections.abc import Callable, Mapping
from typing import Any

import mujoco

from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.errors import InputError, PluginError, SimkitError
from simkit.pose import Pose
from simkit.runtime.clock import Clock
from simkit.runtime.entities import Entities, carry_fields, place_light
from simkit.runtime.joint import Joint
from simkit.runtime.light import Light
from simkit.runtime.link import Link
from simkit.runtime.model import Model
from simkit.runtime.parts import Parts, Structure
from simkit.runtime.physics import CONTROL, STALE, HeldState, Physics
from simkit.runtime.random import RandomStreams
from simkit.runtime.scheduler import Scheduler
from simkit.runtime.snapshot import Snapshot
from simkit.runtime.topics import Callback, Subscription, TopicBus
from simkit.scene import SceneLink, SceneModel, SceneWorld

_LIMIT_GRID = 100.0  # [Hz] at which a velocity limit of the file is held on a joint that nothing drives

SpawnLoader = Callable[..., tuple[SceneModel, Diagnostics]]
PartsMaker = Callable[..., Parts]


class Simulation:
    """A loaded world. Made by `simkit.load`; also a context manager.

    Everything read shows the state at `time`.
    """

    def __init__(
        self,
        world: SceneWorld,
        structure: Structure,
        diagnostics: Diagnostics,
        seed: int,
        load_model: SpawnLoader,
        make_parts: PartsMaker,
    ) -> None:
        self.world = world
        self.log = logging.getLogger("simkit")
        self.clock = Clock(world.physics.max_step_size)
        self.bus = TopicBus()
        self.streams = RandomStreams(seed)
        self.seed = seed
        self._diagnostics = diagnostics
        self._load_model, self._make_parts = load_model, make_parts
        self.scheduler = Scheduler(self.clock)
        self.physics = Physics(structure.compiled.model, structure.compiled.data, self.clock)
        self._originals: dict[str, Any] = {}
        self._exact_limits: list[Joint] = []
        self._attached: set[Any] = set()
        self._loaded_plugins: list[Any] = []  # removed ones too: a restore may bring them back
        self._closed = False
        self._advancing = self._rates_changed = False
        self._entities = Entities(self, world)
        self._adopt(structure)
        self._start(list(structure.parts.values()), diagnostics)
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

    def _advance(self, target: int) -> None:
        self._check_open()
        self._advancing = True
        try:
            self._loop(target)
        finally:
            self._advancing = False

    def _loop(self, target: int) -> None:
        physics, bus = self.physics, self.bus
        before, sense, after = self.scheduler.before, self.scheduler.sense, self.scheduler.after
        while physics.tick < target:
            tick = physics.tick
            if bus.inbox:
                bus.deliver_inputs()
            if before.every or before.next <= tick:
                for task in before.due(tick):
                    task(tick)
            if before.every or after.every or sense.every:
                count = 1
            else:
                count = min(target, before.next, sense.next, after.next) - tick
                if count < 1:
                    count = 1
            physics.advance(count)
            tick = physics.tick
            if sense.next <= tick or sense.every:
                physics.check()
                for task in sense.due(tick):
                    task(tick)
            if after.next <= tick or after.every:
                if tick & 15 == 0 or after.next <= tick:
                    physics.check()
                for task in after.due(tick):
                    task(tick)
            if self._rates_changed:
                self._fill_schedule()
        physics.check()

    # ------------------------------------------------------------------ state

    def reset(self, seed: int | None = None) -> None:
        """Back to t = 0 and to what was loaded: physics, plugins, sensors, random streams (optionally re-seeded)."""
        self._check_open()
        if seed is not None:
            self.seed = seed
        self.bus.settle()
        self.streams.reseed(self.seed)
        self.restore(self._loaded)
        for sensor in self._structure.all_sensors():
            sensor.reset()
        for plugin in self._structure.all_plugins():
            self._call(plugin, "reset")

    def snapshot(self) -> Snapshot:
        """The whole state; a run restored to it repeats bit for bit."""
        self._check_open()
        data = copy.copy(self.mj_data)
        fields = {f: getattr(self.mj_model, f).copy() for f in self._originals}
        fields["gravity"] = self.mj_model.opt.gravity.copy()
        structure, physics = self._structure, self.physics
        return Snapshot(
            tick=self.tick,
            structure=structure,
            data=data,
            fields=fields,
            sensors=[(s, s.get_state()) for s in structure.all_sensors()],
            plugins=[(p, p.get_state()) for p in structure.all_plugins()],
            handles=[(h, h.get_state()) for h in self._entities.stateful()]
            + [(m, m._rest) for m in self._entities.tables["model"].values()],
            inbox=tuple(self.bus.inbox),
            one_shot=physics.one_shot,
            last_applied=physics.last_applied.copy(),
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Back (or forward) to a snapshot of this simulation; what was spawned or removed since is undone."""
        self._check_open()
        if snapshot.structure is not self._structure:
            self._originals = {}
            self._adopt(snapshot.structure)
        model, physics = self.mj_model, self.physics
        for field, original in self._originals.items():
            getattr(model, field)[:] = snapshot.fields.get(field, original)
        for field in snapshot.fields:
            if field != "gravity" and field not in self._originals:
                self.touch(field)[:] = snapshot.fields[field]
        model.opt.gravity[:] = snapshot.fields["gravity"]
        mujoco.mj_copyData(self.mj_data, model, snapshot.data)
        physics.tick = snapshot.tick
        physics.changed(STALE)
        physics.clear_warnings()
        physics.one_shot = snapshot.one_shot
        physics.last_applied = snapshot.last_applied.copy()
        self.bus.inbox.clear()
        self.bus.inbox.extend(snapshot.inbox)
        for handle, state in snapshot.handles:
            if isinstance(handle, Model):
                handle._rest = state
            else:
                handle.set_state(state)
        for sensor, state in snapshot.sensors:
            sensor.set_state(state)
        for plugin, state in snapshot.plugins:
            plugin.set_state(state)
        self.reschedule()

    # ------------------------------------------------------------------ what is in it

    @property
    def models(self) -> dict[str, Model]:
        """Top-level models by name."""
        return dict(self._entities.models)

    @property
    def lights(self) -> dict[str, Light]:
        """Lights by scoped name."""
        return dict(self._entities.tables["light"])

    @property
    def sensors(self) -> dict[str, Any]:
        """Sensors by scoped name."""
        return dict(self._entities.tables["sensor"])

    def model(self, name: str) -> Model:
        """A model by scoped name; KeyError names the closest."""
        found: Model = self._entities.find("model", name)
        return found

    def link(self, name: str) -> Link:
        """A link by scoped name; KeyError names the closest."""
        found: Link = self._entities.find("link", name)
        return found

    def joint(self, name: str) -> Joint:
        """A joint by scoped name; KeyError names the closest."""
        found: Joint = self._entities.find("joint", name)
        return found

    def sensor(self, name: str) -> Any:
        """A sensor by scoped name; KeyError names the closest."""
        return self._entities.find("sensor", name)

    def light(self, name: str) -> Light:
        """A light by scoped name; KeyError names the closest."""
        found: Light = self._entities.find("light", name)
        return found

    def has_sensor(self, name: str) -> bool:
        """Whether a sensor of that name is simulated."""
        return name in self._entities.tables["sensor"]

    def scene_link(self, scoped: str) -> SceneLink:
        """A link as the file has it."""
        return self._entities.scene_link(scoped)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What loading approximated or ignored."""
        return list(self._diagnostics)

    @property
    def reports(self) -> Diagnostics:
        """The collection behind `diagnostics`, for parts that have something to report while running."""
        return self._diagnostics

    # ------------------------------------------------------------------ topics

    def publish(self, topic: str, message: Any) -> None:
        """Sends a message object, or a dict of its fields; inputs get it before the next step.

        Raises:
            MessageError: unknown topic, or fields that do not fit.
        """
        self._check_open()
        self.bus.publish(topic, message)

    def subscribe(self, topic: str, callback: Callback | None = None, keep: int | None = None) -> Subscription:
        """Receives a topic, before or after its publisher exists; keeps the last `keep` messages where given."""
        return self.bus.subscribe(topic, callback, keep)

    def topics(self) -> dict[str, str]:
        """Topic -> ROS type name."""
        return self.bus.topics()

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
        return self._structure.compiled.names

    @property
    def compiled(self) -> Any:
        """What the compiler made of the present structure."""
        return self._structure.compiled

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
        """Writes the control of an actuator that a plugin added; the next step sees it."""
        self.mj_data.ctrl[self.names.actuator(actuator)] = value
        self.physics.changed(CONTROL)

    def touch(self, field: str) -> Any:
        """A model field to be written to; snapshots and restores cover it from now on."""
        values = getattr(self.mj_model, field)
        if field not in self._originals:
            self._originals[field] = values.copy()
        return values

    def original(self, field: str) -> Any:
        """A touched field's values as compiled."""
        return self._originals[field]

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
        scene, found = self._load_model(source, name=name, pose=pose, taken=set(self._structure.models))
        old, before = self._structure, self.snapshot()
        builder = old.builder.copy()
        builder.add_model(scene)
        parts = self._make_parts(scene, builder, found)
        found.raise_if_errors()
        compiled = builder.recompile(old.compiled, self.mj_data)
        models, all_parts = {**old.models, scene.name: scene}, {**old.parts, scene.name: parts}
        self._switch(Structure(builder, compiled, models, old.movable, all_parts))
        try:
            self._start([parts], found)
        except SimkitError:
            self.restore(before)
            raise
        self.reschedule()
        self._diagnostics.extend(found)
        return self.model(scene.name)

    def remove(self, name: str) -> None:
        """Takes a top-level model away while time goes on."""
        self._check_open()
        self.model(name)
        if name not in self._structure.models:
            raise InputError(f"{name!r} is not a top-level model; remove {name.split('::')[0]!r}", "SK-NAME-003")
        old = self._structure
        builder = old.builder.copy()
        builder.remove_model(name)
        compiled = builder.recompile(old.compiled, self.mj_data)
        models = {k: v for k, v in old.models.items() if k != name}
        parts = {k: v for k, v in old.parts.items() if k != name}
        self._switch(Structure(builder, compiled, models, old.movable - {name}, parts))
        self.reschedule()

    def make_movable(self, name: str) -> None:
        """Lets a static top-level model be moved: its links become bodies that follow their set pose."""
        old = self._structure
        if name in old.movable:
            return
        builder = old.builder.copy()
        scene = old.models[name]
        builder.remove_model(name)
        builder.add_model(scene, movable=True)
        for sensor in old.parts[name].sensors:
            sensor.build(builder)
        compiled = builder.recompile(old.compiled, self.mj_data)
        self._switch(Structure(builder, compiled, old.models, old.movable | {name}, old.parts))
        self.reschedule()

    def _switch(self, structure: Structure) -> None:
        """Goes on with another structure, the changed model fields carried over."""
        old_model, fields = self.mj_model, dict(self._originals)
        gravity = old_model.opt.gravity.copy()
        self._originals = {}
        tick = self.tick
        new = structure.compiled.model
        for field in fields:
            self._originals[field] = getattr(new, field).copy()
        carry_fields(old_model, new, fields)
        new.opt.gravity[:] = gravity
        self._adopt(structure)
        self.physics.tick = tick

    def _adopt(self, structure: Structure) -> None:
        self.bus.settle()
        self._structure = structure
        compiled = structure.compiled
        tick = self.physics.tick
        self.physics.rebind(compiled.model, compiled.data)
        self.physics.tick = tick
        self._entities.bind(structure)
        self.bus.set_active([*structure.all_sensors(), *structure.all_plugins()])
        for sensor in structure.all_sensors():
            if sensor in self._attached:
                sensor.bind(compiled)

    def _start(self, parts: list[Parts], diagnostics: Diagnostics) -> None:
        """Attaches new sensors, then loads new plugins, in document order; raises LoadError where they found errors."""
        for part in parts:
            for sensor in part.sensors:
                with self.bus.owned_by(sensor):
                    sensor.attach(self)
                self._attached.add(sensor)
                sensor.bind(self._structure.compiled)
        for part in parts:
            for plugin, parent_of in part.plugins:
                with self.bus.owned_by(plugin):
                    self._load_plugin(plugin, parent_of(self))
        diagnostics.raise_if_errors()

    def _load_plugin(self, plugin: Any, parent: Any) -> None:
        try:
            plugin._setup(self, plugin.source)
            plugin.load(parent, plugin.params)
        except SimkitError:
            raise
        except Exception as error:
            raise PluginError(plugin.name, "load", self.time, str(plugin.where), repr(error)) from error
        plugin._remember_loaded()
        self._loaded_plugins.append(plugin)

    def reschedule(self) -> None:
        """Takes changed rates, sensors and plugins into account; within a hook, once the tick is dealt with."""
        self._rates_changed = True
        if not self._advancing:
            self._fill_schedule()

    def _fill_schedule(self) -> None:
        """Fills the scheduler from what is there, in document order."""
        self._rates_changed = False
        scheduler = self.scheduler
        scheduler.clear()
        for joint in self._entities.tables["joint"].values():
            if joint in self._exact_limits:
                scheduler.every(None, joint.clamp_velocity, "sense")
            elif self._coasts_over_limit(joint):
                scheduler.every(_LIMIT_GRID, joint.clamp_velocity, "sense")
        for sensor in self._structure.all_sensors():
            scheduler.every(sensor.update_rate, sensor.sample, "sense")
        for plugin in self._structure.all_plugins():
            for hook, rate, phase in (
                ("before_step", plugin.before_step_rate, "before"),
                ("after_step", plugin.after_step_rate, "after"),
            ):
                if plugin.has_hook(hook):
                    scheduler.every(rate, self._guarded(plugin, hook), phase)  # type: ignore[arg-type]
        scheduler.rewind(self.tick)

    def _coasts_over_limit(self, joint: Joint) -> bool:
        """Whether a joint has a velocity limit of the file that no servo keeps."""
        limits = joint._velocity_limit
        return joint.dof > 0 and bool((limits < 1e6).any())

    def limit_velocity(self, joint: Joint) -> None:
        """Holds a joint's velocity limit at every step from now on."""
        if joint not in self._exact_limits:
            self._exact_limits.append(joint)
        self.reschedule()

    def place_light(self, light: Light) -> None:
        """Shows a light where its handle says."""
        scene = light.scene
        place_light(self.mj_model, light, scene.scoped, light._pose, self.touch)

    def _guarded(self, plugin: Any, hook: str) -> Callable[[int], None]:
        method = getattr(plugin, hook)

        def task(_: int) -> None:
            try:
                method()
            except SimkitError:
                raise
            except Exception as error:
                raise PluginError(plugin.name, hook, self.time, str(plugin.where), repr(error)) from error

        return task

    def _call(self, plugin: Any, hook: str) -> None:
        self._guarded(plugin, hook)(self.tick)

    # ------------------------------------------------------------------ the end

    def close(self) -> None:
        """Closes plugins and sensors; further calls do nothing."""
        if self._closed:
            return
        for plugin in self._loaded_plugins:
            self._call(plugin, "close")
        for sensor in self._structure.all_sensors():
            sensor.close()
        self._closed = True

    def _check_open(self) -> None:
        if self._closed:
            raise InputError("the simulation is closed", "SK-CORE-002")

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __deepcopy__(self, memo: Mapping[int, Any]) -> Simulation:
        return self
