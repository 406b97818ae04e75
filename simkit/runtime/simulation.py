"""Running simulation: the object that users step, read and command."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any, Final, cast

from simkit.argument_checks import check_function, check_kind, check_table, checked_seed
from simkit.errors import LoadError, NodeError, SimulationDiverged
from simkit.facade import pack_module
from simkit.in_process import InProcess
from simkit.memory_error import find_memory_error
from simkit.pose import Pose, Vector
from simkit.run_spec import PluginErrorPolicy, RunSpec
from simkit.runtime.communication.communication import Communication
from simkit.runtime.communication.journal import journaled
from simkit.runtime.communication.large_commands import forget_commands, large_commands
from simkit.runtime.communication.script_graph import ScriptGraph
from simkit.runtime.communication.topic_bus import TopicBus
from simkit.runtime.engine.engine import Engine
from simkit.runtime.engine.engine_state import EngineCallbacks
from simkit.runtime.engine.plugin_faults import add_driver_hints
from simkit.runtime.engine.simulated_time import Clock
from simkit.runtime.engine.snapshot import Snapshot, Snapshots, Stateful
from simkit.runtime.engine.step_tasks import StepTasks
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.notebook_tables import world_html
from simkit.runtime.moment.explain_moment import explain_moment
from simkit.runtime.moment.moment import Moment
from simkit.runtime.portable_snapshot import PortableSnapshot, pack_snapshot, unpack_snapshot
from simkit.runtime.script_entities import ScriptEntities
from simkit.runtime.world_contents import WorldContents
from simkit.runtime.world_control import Page, Programs, WorldControl
from simkit.runtime.world_source import LoadedState, WorldSource
from simkit.topic_logger import TopicLogger

if TYPE_CHECKING:
    import mujoco

    from simkit.diagnostics import Diagnostic, Diagnostics
    from simkit.facade import NodeProgram
    from simkit.runtime.communication.name_remapping import NameRemapping
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.scheduler import Scheduler
    from simkit.scene import SceneWorld


_ASYNC_SLICE: Final = 0.02  # [s] wall time in which `run_async` does not return to the event loop


class Simulation(ScriptEntities, ScriptGraph, InProcess):
    """Loaded world, made by `simkit.load`; also a context manager.

    All readings show the state at `time`.

    Attributes:
        engine: physics, step loop, servos, random streams, plugin faults.
        communication: topics, services, actions and live parameters.
        contents: models, links, joints, sensors and plugins, with functions to add and remove them.
        control: pause, gravity, collisions, geographic origin, reset of models.
        loaded: state to which a reset returns.

    Args:
        world: scene of the world.
        structure: compiled structure of the world.
        diagnostics: collection of the diagnostics of the load and of the run.
        seed: seed of all random streams.
        source: functions that read and write files.
        on_error: policy for plugins that raise; None uses the policy of the file or of the plugin's class.
        run_spec: specification of the run.
        render_thread: True to draw camera images on another thread.
        remapping: other names for the topics, services and actions of plugins and sensors; None for none.
    """

    _internal_names = frozenset({"communication", "contents", "control", "engine", "loaded", "ros1_parameters"})

    communication: Communication
    contents: WorldContents
    control: WorldControl

    def __init__(
        self,
        world: SceneWorld,
        structure: WorldStructure,
        diagnostics: Diagnostics,
        seed: int,
        source: WorldSource,
        *,
        on_error: PluginErrorPolicy | None = None,
        run_spec: RunSpec | None = None,
        render_thread: bool = False,
        remapping: NameRemapping | None = None,
    ) -> None:
        self._page = cast("Page | None", None)
        self._programs = cast("Programs | None", None)
        self.loaded = LoadedState(world, run_spec)
        self._bus = bus = TopicBus(diagnostics, lambda: self.time, remapping)
        callbacks = EngineCallbacks(
            fill=self._fill,
            schedule_inputs=self._schedule_inputs,
            velocity_limit=lambda name, axis: self.contents.handles.velocity_limit(name, axis),
            set_active=lambda owners: self.communication.set_active(owners),
            abandon=lambda owner, reason: self.communication.abandon(owner, reason),
            large_commands=lambda: large_commands(bus),
        )
        clock, log = Clock(world.physics.max_step_size), TopicLogger("simkit", self, "simkit")
        self.engine = Engine(
            world, structure, clock, seed, diagnostics, log, callbacks, bus, on_error, render_thread=render_thread
        )
        self._tasks = StepTasks(self.engine)
        self.communication = Communication(bus, self.engine)
        self._snapshots = Snapshots(
            self, self.engine, self._stateful, bus.inbox, self._adopt, partial(pack_snapshot, self)
        )
        self.contents = WorldContents(self, self.engine, self.communication, self._snapshots, source)
        self.control = WorldControl(self.engine, bus, self.contents.handles, self._advance, self.loaded, source)
        self.contents.spawner.adopt(structure)
        try:
            self.contents.spawner.start(list(structure.parts.values()), diagnostics)
        except LoadError:
            self.contents.spawner.close_plugins()  # the world may be built again without a faulty plugin
            raise
        self.engine.reschedule()
        self.loaded.change(self.snapshot())

    @property
    def run_spec(self) -> RunSpec | Any:
        """Specification of the run from `simkit.load`; None for a simulation made in another way."""
        return self.loaded.run_spec

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

    def run_until(self, condition: Callable[[Simulation], bool] | str, timeout: float) -> bool:
        """Step until a condition holds after a step; return False if `timeout` [s] passed first.

        Args:
            condition: function of the simulation, or text such as `"pose('bot').x > 0.5"`, as in scenario files.
            timeout: longest simulated time [s].

        Raises:
            InputError: the text has a syntax error or an unknown name, or is not true or false (SK-COND-…).
        """
        self.engine.check_open()
        if isinstance(condition, str):
            with pack_module("sim.run_until").opened_condition(self, condition) as holds:
                return self.run_until(holds, timeout)
        check_function(condition, "condition")
        for _ in range(self.engine.clock.checked_ticks(timeout, "timeout")):
            self.step()
            if condition(self):
                return True
        return False

    def _advance(self, target: int, *, is_served: bool = False) -> None:
        self.engine.check_open()
        self.communication.log_topic.use_thread()
        advance: Callable[[int], None] = partial(self._make_steps, is_served=is_served)
        if self._programs is not None:
            advance = partial(self._programs.advance, advance=advance)
        try:
            if self._page is None or is_served:
                advance(target)
            else:
                self._page.advance(target, advance)
        except SimulationDiverged as error:
            add_driver_hints(self.engine.structure.all_plugins(), error, large_commands(self._bus))
            raise
        except Exception as error:
            if too_little := find_memory_error(error):
                raise too_little from error
            raise

    def _make_steps(self, target: int, *, is_served: bool) -> None:
        journal = self._bus.journal
        if journal is None:
            self.engine.loop.advance(target, is_served=is_served)
            return
        journal.before_steps()
        try:
            self.engine.loop.advance(target, is_served=is_served)
        finally:
            journal.after_steps()

    def reset(self, seed: int | None = None, *, keep_changes: bool = False) -> None:
        """Reset physics, plugins, sensors and random streams to the loaded state at t = 0.

        Args:
            seed: new seed of all random streams; None keeps the present one.
            keep_changes: True to keep masses, friction, joint dynamics, gains, noise, lights and gravity that were set.
        """
        check_kind(keep_changes, bool, "keep_changes", "True or False")
        self.engine.check_open()
        kept = (self.gravity, self.engine.numbers.values) if keep_changes else None
        if self._programs is not None:
            self._programs.end()
        self._reset(seed)
        if kept is not None:
            self.gravity = kept[0]
            self.contents.handles.set_values(kept[1])
        if self._programs is not None:
            self._programs.restart()

    @journaled
    def _reset(self, seed: int | None = None) -> None:
        engine = self.engine
        engine.check_open()
        loaded = self.loaded.snapshot
        seed = engine.streams.seed if seed is None else checked_seed(seed)
        engine.loop.drop_deferred()
        self.communication.bus.settle()
        forget_commands(self._bus)
        engine.streams.reseed(seed)
        self.contents.spawner.restore(loaded)
        for sensor in engine.structure.all_sensors():
            sensor.reset()
        for plugin in engine.structure.all_plugins():
            if plugin.has_hook("reset"):
                engine.faults.task(plugin, "reset")(0)

    @journaled
    def snapshot(self, *, compact: bool = False) -> Snapshot:
        """Return the whole state; a run that is restored to it repeats bit for bit.

        If a hook or a callback requests a snapshot, the state is stored in the snapshot at the end of the present step.
        Use this snapshot only after the step.

        Args:
            compact: leave out what follows from the state. Such a snapshot takes a fifth of the memory, is faster, and
                cannot be pickled. It has no effect during a step, and where bodies may sleep.
        """
        self.engine.check_open()
        if self._programs is not None:
            self._programs.note_snapshot()
        if not self.engine.is_stepping:
            return self._snapshots.take(compact=compact)
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
        before_ns = self.time_ns
        engine.loop.drop_deferred()
        if snapshot.seed != engine.streams.seed:
            self.communication.bus.settle()
            engine.streams.reseed(snapshot.seed)
        self.contents.spawner.restore(snapshot)
        if self._programs is not None:
            self._programs.follow_restore(before_ns)

    def _adopt(self, structure: WorldStructure) -> None:
        self.contents.spawner.adopt(structure)

    def _stateful(self) -> list[Stateful]:
        """Return every part with a state, except sensors and plugins, in the order of restoring."""
        engine, interfaces, control, handles = self.engine, self.communication, self.control, self.contents.handles
        of_simulation = (engine.faults, *interfaces.stateful(), control.pausing, control.origin)
        return [
            *handles.stateful(),
            *of_simulation,
            engine.numbers,
            engine.velocity_servos,
            *handles.tables["model"].values(),
        ]

    @property
    def world(self) -> SceneWorld:
        """World as the file describes it."""
        return self.engine.world

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
        spawn = partial(self.contents.spawn_all, [(source, name, pose)])
        return (spawn() if self._programs is None else self._programs.call_outside(spawn))[0]

    def remove(self, name: str) -> None:
        """Remove a top-level model during the run."""
        remove = partial(self.contents.remove, name)
        remove() if self._programs is None else self._programs.call_outside(remove)

    @property
    def gravity(self) -> Vector:
        """Gravity [m/s²], world frame, shape (3,); settable at any time."""
        return self.control.gravity

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        self.control.gravity = value

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
        self._tasks.fill(scheduler, *self.contents.handles.limited_dofs())
        self.communication.on_demand.fill(scheduler)

    def _schedule_inputs(self) -> object:
        """Return what `_fill` reads and a restored state may change; None if each state needs new tasks."""
        return self._tasks.inputs(self.contents.handles.velocity_limits(), self.communication.on_demand.wanted())

    def view(self, port: int = 0) -> str:
        """Show the simulation in a browser; `step` and `run` then update the page.

        Args:
            port: port of the page on this machine; 0 for a free one. Only the first call uses it.

        Returns:
            Address of the page. A notebook shows the page itself.

        Raises:
            InputError: SK-INPUT-004 the pack view is not installed, or SK-WEB-006 the port cannot be used.
        """
        self.engine.check_open()
        if self._page is None:
            self._page = pack_module("sim.view").ScriptView(self, port)
        return self._page.address

    def why(self, model: str | None = None, joint: str | None = None) -> Moment:
        """Explain the present moment: contacts, joints, constraints and wheels, with what slides or has a limit.

        `print(sim.why())` prints sentences. The attributes of the result have the numbers.

        Args:
            model: scoped name of a model; None for all models.
            joint: scoped name of a joint, or its last name if only one joint has it; None for all joints.

        Raises:
            KeyError: no such model or joint; the message suggests the closest name.
        """
        return explain_moment(self.engine, self.contents.open_handles, model, joint)

    def add_node(
        self,
        program: str | PathLike[str] | Callable[[], object],
        *,
        name: str | None = None,
        namespace: str | None = None,
        remap: Mapping[str, str] | None = None,
        params: Mapping[str, object] | None = None,
        args: Sequence[str] = (),
        latency: float | tuple[float, float] = 0.0,
        discovery: float = 0.0,
        limit: float = 60.0,
        restart: float | None = None,
        keys: str | Sequence[tuple[float, str]] | None = None,
        label: str | None = None,
        after: Mapping[str, str] | None = None,
        delay: float = 0.0,
        respawn: float | None = None,
        ends_run: bool = False,
        env: Mapping[str, str] | None = None,
        cwd: str | PathLike[str] | None = None,
    ) -> NodeProgram:
        """Run a program for ROS in lock-step with the simulation: it runs only between steps, in simulated time.

        The program starts with the next call of `step` or `run`, or when the condition of `after` and `delay` holds.
        Programs that start at the same time start in the order in which they were added. A reset starts all anew.

        Args:
            program: Python file, `PACKAGE/EXECUTABLE` of a ROS workspace or of a known node, or function.
            name: name of its node, instead of the one in the program.
            namespace: namespace of its node.
            remap: new names by the names in the program, for topics, services and actions.
            params: values of parameters by name.
            args: further arguments of the command line.
            latency: delay of all messages to the program [s], simulated time; two numbers are the limits of a delay
                that is drawn for each message.
            discovery: simulated time until its publishers and subscriptions are matched [s]; at least one step.
            limit: wall time that the program may compute without waiting [s]; a longer time is an error.
            restart: simulated time after which the program starts anew if it raised an exception [s]; None for never.
            keys: what the program reads from its standard input: a text as of a file, or texts with the simulated times
                [s] at which somebody types them. By default nobody types.
            label: name of the program in `after` of others; None for `name`, or the name of the program.
            after: `{"exit": LABEL}` or `{"start": LABEL}`: the program starts after the first exit or start of another
                one. By default it starts at once.
            delay: simulated time between this event, or the present time, and the start [s].
            respawn: simulated time after which the program starts again whenever it has ended [s]; None for never.
            ends_run: True to end all programs and the run as soon as the program has ended.
            env: variables of the environment that the program has besides those of the process.
            cwd: working directory of the program; None for that of the process.

        Raises:
            InputError: SK-INPUT-004 the pack nodes is not installed, or the program does not exist, or SK-NODE-065 two
                nodes have one label.
        """
        programs = self._started_programs("sim.add_node")
        add = partial(
            programs.add,
            program,
            name=name,
            namespace=namespace,
            remap=remap or {},
            params=params or {},
            args=args,
            latency=latency,
            discovery=discovery,
            limit=limit,
            restart=restart,
            keys=keys,
            label=label,
            after=after,
            delay=delay,
            respawn=respawn,
            ends_run=ends_run,
            env=env,
            cwd=cwd,
        )
        added: NodeProgram = programs.call_outside(add)
        return added

    def set_ros_parameters(self, values: Mapping[str, object]) -> None:
        """Set parameters of the parameter server of ROS 1, which all programs of ROS 1 share; a reset keeps them.

        Args:
            values: values by absolute name, such as `{"/robot/speed": 0.2}`; dictionaries are namespaces.

        Raises:
            InputError: SK-INPUT-004 the pack nodes is not installed, or SK-NODE-066 a name or a value is not allowed.
        """
        check_table(values, object, "values", "parameters")
        self._started_programs("sim.set_ros_parameters").set_parameters(values)

    def ros1_parameters(self) -> Any:
        """Return the parameter server of ROS 1, which all programs of ROS 1 share; for clients in other processes."""
        return self._started_programs("sim.set_ros_parameters").parameters

    def _started_programs(self, name: str) -> Programs:
        """Return the programs of the simulation, which a user's name needs."""
        self.engine.check_open()
        if self._programs is None:
            self._programs = cast("Programs", pack_module(name).LockStep(self))
        return self._programs

    @property
    def ended_by(self) -> str:
        """Name of the program with `ends_run` whose end has ended the run; empty before."""
        return "" if self._programs is None else self._programs.ended_by

    @property
    def nodes(self) -> tuple[NodeProgram, ...]:
        """Programs of `add_node`, in the order in which they were added."""
        return () if self._programs is None else tuple(self._programs.programs)

    def check_nodes(self) -> None:
        """Check that no program of `add_node` raised an exception; the runs of scenarios do this at their end.

        Programs that are not done report at first what is only known at the end of a run.

        Raises:
            NodeError: SK-SCEN-010 a program raised; the error names all such programs.
        """
        for program in self.nodes:
            for report in () if program.done else program.on_report:
                report()
        failed = [program for program in self.nodes if program.error is not None]
        if failed:
            raise NodeError([program.failure for program in failed]) from failed[0].error

    def close(self) -> None:
        """Close plugins and sensors; further calls do nothing."""
        engine = self.engine
        if engine.is_closed:
            return
        if self._programs is not None:
            self._programs.close()
        if self._page is not None:
            self._page.close()
        first = self.contents.spawner.close_plugins()
        for sensor in engine.structure.all_sensors():
            sensor.close()
        self.contents.handles.close()
        engine.close()
        if first is not None:
            raise first

    def __repr__(self) -> str:
        if not self.loaded.is_complete:
            return "<Simulation (being loaded)>"
        plural = "" if len(self.contents.models) == 1 else "s"
        state = "closed" if self.engine.is_closed else f"t={self.time:g} s, {len(self.contents.models)} model{plural}"
        return f"<Simulation {self.world.name!r}: {state}>"

    def _repr_html_(self) -> str:
        return world_html(repr(self), {} if self.engine.is_closed else self.models)

    def __enter__(self) -> Simulation:
        self.engine.check_open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
