"""A running simulation: what a user steps, reads and talks to."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from simkit.errors import InputError, SimulationDiverged
from simkit.pose import Pose, Vector
from simkit.run_spec import PluginErrorPolicy, RunSpec
from simkit.runtime.communication.action_server import EndCallback, GoalHandle
from simkit.runtime.communication.communication import Communication
from simkit.runtime.communication.journal import journaled
from simkit.runtime.communication.service_server import Service, ServiceHandler
from simkit.runtime.communication.subscription import Callback, CallbackPolicy, Subscription
from simkit.runtime.communication.topic_bus import TopicBus
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
from simkit.runtime.spawner import ModelLoader, SensorsAndPluginsMaker
from simkit.runtime.world_contents import WorldContents
from simkit.runtime.world_control import WorldControl

if TYPE_CHECKING:
    import mujoco

    from simkit.diagnostics import Diagnostic, Diagnostics
    from simkit.runtime.communication.subscription import Callback, Message
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.scheduler import Scheduler
    from simkit.scene import SceneWorld


class Simulation:
    """A loaded world. Made by `simkit.load`; also a context manager.

    Everything read shows the state at `time`.

    Attributes:
        engine: physics, step loop, servos, random streams, plugin faults.
        communication: topics, services, actions and live parameters.
        contents: models, links, joints, sensors and plugins, and how they are added and removed.
        control: pause, gravity, collisions, geographic origin, reset of models.
        run_spec: description of the run that `simkit.load` made it from; None where it was made otherwise.
    """

    run_spec: RunSpec | None = None

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
        state = self._loaded_state
        self.control = WorldControl(self.engine, bus, self.contents.handles, self._advance, state)
        self.contents.spawner.adopt(structure)
        self.contents.spawner.start(list(structure.parts.values()), diagnostics)
        self.engine.reschedule()
        self._loaded = self.snapshot()

    @property
    def tick(self) -> int:
        """Steps done."""
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
        """Advances `count` steps; raises SimulationDiverged, and PluginError where a plugin raised."""
        if count < 0:
            raise ValueError(f"count must not be negative, got {count}")
        self._advance(self.tick + int(count))

    def run(self, duration: float) -> None:
        """Advances a duration [s] of simulated time, to the nearest whole step; also where a hook goes back in time."""
        if not duration >= 0:
            raise ValueError(f"duration must be a number of seconds that is not negative, got {duration}")
        self._advance(self.tick + self.engine.clock.ticks(duration))

    def run_until(self, condition: Callable[[Simulation], bool], timeout: float) -> bool:
        """Steps until `condition(sim)`, asked after every step, holds; False when `timeout` [s] passed before."""
        for _ in range(self.engine.clock.ticks(timeout)):
            self.step()
            if condition(self):
                return True
        return False

    def _advance(self, target: int, *, is_served: bool = False) -> None:
        self.engine.check_open()
        journal = self._bus.journal
        if journal is not None:
            journal.before_steps()
        try:
            self.engine.loop.advance(target, is_served=is_served)
        except SimulationDiverged as error:
            add_driver_hints(self.engine.structure.all_plugins(), error)
            raise
        finally:
            if journal is not None:
                journal.after_steps()

    @journaled
    def reset(self, seed: int | None = None) -> None:
        """Back to t = 0 and to what was loaded: physics, plugins, sensors, random streams (optionally re-seeded)."""
        loaded, engine = self._loaded_state(), self.engine
        engine.loop.drop_deferred()
        self.communication.bus.settle()
        engine.streams.reseed(engine.streams.seed if seed is None else seed)
        self._restore(loaded)
        for sensor in engine.structure.all_sensors():
            sensor.reset()
        for plugin in engine.structure.all_plugins():
            engine.faults.task(plugin, "reset")(0)

    @journaled
    def snapshot(self) -> Snapshot:
        """The whole state; a run restored to it repeats bit for bit.

        Asked for by a hook or a callback it is that of the end of the step under way, and complete from then on.
        """
        self.engine.check_open()
        snapshots = self.contents.spawner.snapshots
        if not self.engine.is_stepping:
            return snapshots.take()
        snapshot, keep = snapshots.promise()
        self.engine.loop.defer(keep)
        return snapshot

    @journaled
    def restore(self, snapshot: Snapshot) -> None:
        """Back (or forward) to a snapshot of this simulation; what was spawned or removed since is undone.

        Raises:
            ValueError: the snapshot is of another simulation, or was asked for within a step that has not ended.
        """
        engine = self.engine
        engine.check_open()
        if snapshot.owner is not self:
            raise ValueError("the snapshot is of another simulation; each goes back to its own only")
        if not snapshot.is_complete:
            raise ValueError("the snapshot was asked for within a step that has not ended; restore it after that step")
        engine.loop.drop_deferred()
        if snapshot.seed != engine.streams.seed:
            self.communication.bus.settle()
            engine.streams.reseed(snapshot.seed)
        self._restore(snapshot)

    def _restore(self, snapshot: Snapshot) -> None:
        self.contents.spawner.snapshots.restore(snapshot)
        self.engine.loop.halt()  # a run that is served looks anew at how far it is to go
        self.engine.reschedule()
        self.contents.spawner.forget_gone()

    def _stateful(self) -> list[Stateful]:
        """Every part with a state besides sensors and plugins, in the order in which they are restored."""
        engine, talk, control, handles = self.engine, self.communication, self.control, self.contents.handles
        own = (engine.faults, talk.live_parameters, talk.actions, control.pausing, control.origin)
        return [*handles.stateful(), *own, engine.velocity_servos, *handles.tables["model"].values()]

    def _loaded_state(self) -> Snapshot:
        self.engine.check_open()
        if "_loaded" not in vars(self):
            raise InputError("the world is still being loaded, there is nothing yet to go back to", "SK-CORE-004")
        return self._loaded

    @property
    def world(self) -> SceneWorld:
        """The world as the file describes it."""
        return self.engine.world

    @property
    def models(self) -> dict[str, Model]:
        """Top-level models by name."""
        return self.contents.models

    def model(self, name: str) -> Model:
        """A model by scoped name; KeyError names the closest."""
        return self.contents.handles.model(name)

    def link(self, name: str) -> Link:
        """A link by scoped name; KeyError names the closest."""
        return self.contents.handles.link(name)

    def joint(self, name: str) -> Joint:
        """A joint by scoped name; KeyError names the closest."""
        return self.contents.handles.joint(name)

    def sensor(self, name: str) -> Any:
        """A sensor by scoped name; KeyError names the closest."""
        return self.contents.handles.find("sensor", name)

    def light(self, name: str) -> Light:
        """A light by scoped name; KeyError names the closest."""
        return self.contents.handles.light(name)

    def visual(self, name: str) -> Visual:
        """A visual by scoped name; KeyError names the closest."""
        return self.contents.handles.find_visual(name)

    def spawn(self, source: object, name: str | None = None, pose: Pose | None = None) -> Model:
        """Adds a model while time goes on; everything else keeps its state and its handles.

        Args:
            source: a file, XML text, or the bare name of a model.
            name: instead of the file's own.
            pose: of the model frame in the world, instead of the file's own.

        Raises:
            LoadError: the source has errors, or the name is taken.
            InputError: no model can have this name.
        """
        return self.contents.spawn_all([(source, name, pose)])[0]

    def remove(self, name: str) -> None:
        """Takes a top-level model away while time goes on."""
        self.contents.remove(name)

    @property
    def gravity(self) -> Vector:
        """Acceleration that everything feels [m/s²], world frame, shape (3,); settable at any time."""
        return self.control.gravity

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        self.control.gravity = value

    @property
    def plugins(self) -> dict[str, Any]:
        """Plugins that the file made, by scoped name."""
        return self.contents.plugins

    @property
    def paused(self) -> bool:
        """Whether the world is paused, as its services and `simkit run` understand it; settable."""
        return self.control.paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self.control.paused = paused

    def publish(self, topic: str, message: Message) -> None:
        """Sends a message object, or a dict of its fields; inputs get it before the next step.

        Raises:
            MessageError: unknown topic, or fields that do not fit.
        """
        self.engine.check_open()
        self.communication.bus.publish(topic, message)

    def subscribe(
        self, topic: str, callback: Callback | None = None, keep: int | None = None, on_error: CallbackPolicy = "stop"
    ) -> Subscription:
        """Receives a topic, before or after its publisher exists.

        Args:
            callback: called with each message.
            keep: how many messages are kept, the newest; a million by default.
            on_error: of a callback that raises: "stop" ends the run with a SubscriberError, "drop" the subscription.
        """
        return self.communication.bus.subscribe(topic, callback, keep, on_error)

    def topics(self) -> dict[str, str]:
        """Topic -> ROS type name."""
        return self.communication.bus.topics()

    def call(self, service: str, request: Message = None) -> Message:
        """The response of a service to a message, a dict of its fields, or None for all zero.

        Raises:
            ServiceError: there is no such service; names the closest.
            MessageError: the request does not fit.
            PluginError: the service of a plugin raised.
        """
        self.engine.check_open()
        return self.communication.services.call(service, request)

    def offer(self, service: str, type_name: str, handler: ServiceHandler) -> Service:
        """Opens a service of a type such as `std_srvs/srv/Trigger`.

        Args:
            service: absolute, or taken as such.
            type_name: its type.
            handler: given the request, gives the response: a message, a dict of its fields, or None for all zero.

        Raises:
            ServiceError: there is one of that name.
            MessageError: an unknown type.
        """
        return self.communication.services.offer(service, type_name, handler)

    def send_goal(
        self, action: str, goal: Message = None, on_feedback: Callback | None = None, on_done: EndCallback | None = None
    ) -> GoalHandle:
        """Sends a goal; the plugin has it before the next step.

        Args:
            goal: a message, a dict of its fields, or None for all zero.
            on_feedback: called with each feedback message.
            on_done: called with the handle once the goal has ended.

        Raises:
            ActionError: there is no such action; names the closest.
            MessageError: the goal does not fit.
        """
        self.engine.check_open()
        return self.communication.actions.send(action, goal, on_feedback, on_done)

    def set_parameter(self, node: str, name: str, value: object) -> None:
        """Changes a live parameter; raises ParameterError where none has that name or takes the value."""
        self.communication.set_parameter(node, name, value)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What loading approximated or ignored."""
        return list(self.engine.reports)

    @property
    def mj_model(self) -> mujoco.MjModel:
        """The `mujoco.MjModel`; a new object after a spawn or a removal."""
        return self.engine.physics.model

    @property
    def mj_data(self) -> mujoco.MjData:
        """The `mujoco.MjData`; a new object after a spawn or a removal."""
        return self.engine.physics.data

    def _fill(self, scheduler: Scheduler) -> None:
        handles = self.contents.handles
        fill_schedule(self.engine, scheduler, handles.tables["joint"].values(), handles.exact_limits)
        self.communication.on_demand.fill(scheduler)

    def close(self) -> None:
        """Closes plugins and sensors; further calls do nothing."""
        engine = self.engine
        if engine.is_closed:
            return
        first = self.contents.spawner.close_plugins()
        for sensor in engine.structure.all_sensors():
            sensor.close()
        engine.is_closed = True
        if first is not None:
            raise first

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __deepcopy__(self, memo: Mapping[int, object]) -> Simulation:
        return self
