"""Control of a whole world: pause, gravity, collisions, geographic origin, random seed, reset of models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import mujoco
import numpy as np

from simkit.argument_checks import checked_vector
from simkit.compiler.start_positions import place_joints
from simkit.compiler.state_transfer import copy_state
from simkit.errors import InputError
from simkit.pose import Vector
from simkit.runtime.communication.journal import journaled
from simkit.runtime.engine.physics_state import STALE
from simkit.runtime.model_copy import present_world

if TYPE_CHECKING:
    from simkit.runtime.communication.command_queue import CommandQueue
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.snapshot import Snapshot
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.world_source import LoadedState, WorldSource
    from simkit.scene import SphericalCoordinates


R = TypeVar("R")


class Advance(Protocol):
    """Function that makes the steps up to a tick."""

    def __call__(self, target: int, *, is_served: bool = False) -> None:
        """Advance to `target`; a served run ends earlier if the loop is halted."""


class PauseControl:
    """Pause state of a run: pausing, stepping, and running to a time.

    As in Gazebo's server, pausing stops the code that keeps a world running (`simkit run`), and resuming continues it.
    A script that calls `step` or `run` sets its own target and reaches it, like Gazebo's multi-step.

    Args:
        engine: engine of the simulation.
        advance: function that makes the steps.
        commands: command queue, whose generation changes with a restore or a reset.

    Attributes:
        until: tick at which the run pauses; None if it continues.
        is_stepping: True while the run makes requested steps up to `until`.
        pace: requested highest real-time factor; None for none. Not part of the world's state.
        is_served: True while other code keeps the world running and carries out requests.
        is_over: True after the end of the run, so that `advance` stops. Not part of the world's state.
    """

    def __init__(self, engine: Engine, advance: Advance, commands: CommandQueue) -> None:
        self._engine, self._advance, self._commands = engine, advance, commands
        self.until: int | None = None
        self.is_stepping = False
        self.pace: float | None = None
        self.is_served = self.is_over = False
        self._watchers: list[Callable[[], None]] = []

    @property
    def is_paused(self) -> bool:
        """True while the world is paused."""
        return self.until is not None and self._engine.tick >= self.until

    def on_change(self, callback: Callable[[], None]) -> None:
        """Call a function whenever the world is paused or resumed, or steps are requested."""
        self._watchers.append(callback)

    def pause(self) -> None:
        """Pause the world after the present step."""
        self._set(self._engine.tick, is_stepping=False)

    def resume(self) -> None:
        """Resume the world."""
        self._set(None, is_stepping=False)

    def step(self, count: int) -> None:
        """Make a paused world do `count` steps and pause again; several requests add up."""
        left = self.until - self._engine.tick if self.until is not None and self.is_stepping else 0
        self._set(self._engine.tick + max(0, left) + count, is_stepping=True)

    def run_to(self, time_ns: int) -> None:
        """Run the world to the first tick at or after a simulated time [ns], and pause there."""
        self._set(self._engine.clock.tick_at(time_ns), is_stepping=False)

    def catch_up(self) -> None:
        """Run to the pause tick if no step is active and no other code keeps the world running."""
        engine = self._engine
        if self.until is not None and not self.is_served and not engine.is_stepping and self.until > engine.tick:
            self._advance(self.until)

    @contextmanager
    def served(self) -> Iterator[None]:
        """Mark the world as kept running by other code within the context."""
        self.is_served = True
        try:
            yield
        finally:
            self.is_served = False

    def end(self) -> None:
        """End a served run after the present step."""
        self.is_over = True
        self._engine.loop.halt()

    def advance(self, count: int) -> None:
        """Advance by up to `count` steps, limited by the pause tick; `simkit run` calls it repeatedly.

        The call also ends when a hook restores a state, even if that state has the time at which the call began.
        """
        engine = self._engine
        end, commands = engine.tick + count, self._commands
        generation = commands.generation
        while commands.generation == generation and not self.is_over:
            stop = end if self.until is None else min(end, self.until)
            if engine.tick >= stop:
                return
            self._advance(stop, is_served=True)

    def _set(self, until: int | None, *, is_stepping: bool) -> None:
        if (until, is_stepping) == (self.until, self.is_stepping):
            return
        self.until, self.is_stepping = until, is_stepping
        self._engine.loop.halt()
        for watcher in self._watchers:
            watcher()

    def get_state(self) -> tuple[int | None, bool]:
        return self.until, self.is_stepping

    def set_state(self, state: tuple[int | None, bool]) -> None:
        self.until, self.is_stepping = state


_MASK_FIELDS = ("geom_contype", "geom_conaffinity")
_PLACE_FIELDS = ("body_pos", "body_quat")  # of bodies that are fixed or hinged to the world and were moved


class GeographicOrigin:
    """Geographic position of the world's origin; sensors that depend on it (`navsat`, `magnetometer`) are notified."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @property
    def place(self) -> SphericalCoordinates | None:
        """World's `<spherical_coordinates>`; None if it has none."""
        return self._engine.world.spherical_coordinates

    def move(self, place: SphericalCoordinates | None) -> None:
        """Move the world's origin."""
        engine = self._engine
        sensors = [s for s in engine.structure.all_sensors() if hasattr(s, "relocate")]
        for sensor in sensors:
            sensor.take_held()
        engine.change_world(replace(engine.world, spherical_coordinates=place))
        for sensor in sensors:
            sensor.relocate()

    def get_state(self) -> SphericalCoordinates | None:
        """Return the position for a snapshot."""
        return self.place

    def set_state(self, state: SphericalCoordinates | None) -> None:
        """Restore a position from `get_state`."""
        if state is not self.place:
            self.move(state)


class Page(Protocol):
    """Page in a browser that shows a simulation which a script steps."""

    @property
    def address(self) -> str:
        """Address of the page."""

    def advance(self, target: int, advance: Callable[[int], None]) -> None:
        """Call `advance` up to the tick `target`, and update the page in between."""

    def close(self) -> None:
        """Close the page."""


class Program(Protocol):
    """Program that runs between the steps of a simulation.

    Attributes:
        name: name in messages.
        file: file of the program; None for a function.
        log: lines of its log, with the traceback of an exception.
        error: exception that ended the program, SystemExit for an exit code that is not 0; None without one.
        exit_code: exit code of the program; 0 without an error.
        done: True after its end.
        hand_overs: number of times that the program got its turn.
        restarts: number of times that the program started anew after an exception.
        failure: name, with the place and the text of the exception, or the exit code; empty without an error.
        label: name that no other program of the run has, if the run gives one.
        awaited: event for which the program has waited until now, such as "the exit of spawn"; empty after its start.
    """

    name: str
    file: Path | None
    log: list[str]
    error: BaseException | None
    done: bool
    exit_code: int
    hand_overs: int
    restarts: int

    @property
    def failure(self) -> str: ...
    @property
    def label(self) -> str: ...
    @property
    def awaited(self) -> str: ...


class Programs(Protocol):
    """Programs that run between the steps of a simulation, such as ROS nodes.

    Attributes:
        programs: programs in the order in which they were added.
        ended_by: name of the program whose end has ended the run; empty before.
    """

    programs: list[Any]
    ended_by: str

    @property
    def parameters(self) -> Any:
        """Parameter server of ROS 1."""

    def add(
        self,
        program: str | PathLike[str] | Callable[[], object],
        *,
        name: str | None,
        namespace: str | None,
        remap: Mapping[str, str],
        params: Mapping[str, object],
        args: Sequence[str],
        latency: float | tuple[float, float],
        discovery: float,
        limit: float,
        restart: float | None,
        keys: str | Sequence[tuple[float, str]] | None,
        label: str | None,
        after: Mapping[str, str] | None,
        delay: float,
        respawn: float | None,
        ends_run: bool,
        env: Mapping[str, str] | None,
        cwd: str | PathLike[str] | None,
    ) -> Any:
        """Add a program and return its handle; see `Simulation.add_node`."""

    def set_parameters(self, values: Mapping[str, object]) -> None:
        """Set parameters of ROS 1 for all programs; see `Simulation.set_ros_parameters`."""

    def call_outside(self, function: Callable[[], R]) -> R:
        """Call a function that changes the world, also for a program, in the thread of the simulation."""

    def advance(self, target: int, advance: Callable[[int], None]) -> None:
        """Call `advance` up to the tick `target`, and run the programs at the ticks for which they wait."""

    def end(self) -> None:
        """End all programs, before a reset."""

    def restart(self) -> None:
        """Start all programs anew, after a reset."""

    def follow_restore(self, before_ns: int) -> None:
        """Continue the programs after a restore, which does not restore them, from a simulated time [ns]."""

    def note_snapshot(self) -> None:
        """Report that a snapshot does not contain the programs."""

    def close(self) -> None:
        """End all programs."""


class WorldControl:
    """Functions behind the services of a world.

    Args:
        engine: engine of the simulation.
        bus: topic bus of the simulation.
        handles: handles of the simulation.
        advance: function that makes steps.
        loaded: state to which a reset returns.
        source: functions that read and write files.
        has_controller_nodes: True if nodes of the run load the controllers of its robots.

    Attributes:
        pausing: pause state.
        origin: geographic position of the world's origin.
        source: functions that read and write files.
    """

    def __init__(
        self,
        engine: Engine,
        bus: TopicBus,
        handles: EntityHandles,
        advance: Advance,
        loaded: LoadedState,
        source: WorldSource,
    ) -> None:
        self._engine, self._bus, self._handles = engine, bus, handles
        self._advance, self._loaded, self.source = advance, loaded, source
        self.pausing = PauseControl(engine, advance, bus.inbox)
        self.origin = GeographicOrigin(engine)
        self.has_controller_nodes = False

    def list_models(self) -> dict[str, str]:
        """Return the sources of the models that can be spawned, by name."""
        return self.source.list_models()

    def client_source(self, source: str) -> str:
        """Return the source of a model that a client wants to spawn: a text, URI, bundled name or path.

        Raises:
            InputError: SK-URI-003 it is a path outside the folders of the run.
        """
        if self.source.check_source is not None:
            self.source.check_source(source)
        return source

    # ------------------------------------------------------------------ running

    @property
    def paused(self) -> bool:
        """True while the world is paused; settable. The services of the world, `simkit run` and Gazebo read this state.

        A script that calls `step` or `run` sets its own target and reaches it all the same.
        """
        return self.pausing.is_paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        self._engine.check_open()
        if not paused:
            self.pausing.resume()
        elif not self.pausing.is_paused:
            self.pausing.pause()

    def serve(self, target: int) -> None:
        """Advance up to a tick, or until the loop is halted.

        Raises:
            SimulationDiverged: the physics diverged.
            PluginError: a plugin raised.
        """
        self._advance(target, is_served=True)

    @journaled
    def reseed(self, seed: int) -> None:
        """Use another seed for all random numbers from now on."""
        self._bus.settle()
        self._engine.streams.reseed(seed)

    @journaled
    def leave_controllers_to_nodes(self) -> None:
        """Leave the start of all controllers to nodes: robots do not start their controllers by themselves."""
        self.has_controller_nodes = True

    # ------------------------------------------------------------------ physics

    @property
    def gravity(self) -> Vector:
        """Gravity [m/s²], world frame, shape (3,); settable at any time."""
        self._engine.check_open()
        return np.array(self._engine.mj_model.opt.gravity)

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        numbers = checked_vector(value, "gravity")
        engine = self._engine
        engine.check_open()
        for sensor in engine.structure.all_sensors():
            sensor.take_held()  # pending values belong to the old gravity
        engine.physics.changed_model()
        engine.mj_model.opt.gravity[:] = numbers
        engine.reschedule()  # tasks that depend on gravity are scheduled again

    def enable_collisions(self, links: Iterable[str], enabled: bool, only: str = "") -> None:
        """Enable or disable the contacts of links; rays detect their collisions all the same.

        Args:
            links: scoped names of the links.
            enabled: True to enable contacts.
            only: scoped name of a single collision; empty for all collisions of the links.
        """
        engine, names = self._engine, self._engine.names
        geoms = [g for link in links for g in names.link(link).geoms if not only or names.geom_owner(g)[1] == only]
        for field in _MASK_FIELDS:
            values = engine.touch(field)
            values[geoms] = engine.original(field)[geoms] if enabled else 0
        engine.physics.changed(STALE)

    # ------------------------------------------------------------------ models

    def to_sdf(self) -> str:
        """Return the world as SDF text: present models at their present poses, with present gravity and lights.

        All joints are at zero in it, because SDF has no element for joint positions.

        Raises:
            InputError: the simulation has no SDF writer.
        """
        if self.source.write_sdf is None:
            raise InputError("this simulation has no SDF writer; create it with simkit.load")
        models = [(handle.scene, handle.pose) for handle in self._handles.models.values()]
        everything = self._handles.tables["light"].values()
        lights = [(light.scene, light.pose) for light in everything if not light.scene.link]
        x, y, z = self.gravity.tolist()
        return self.source.write_sdf(replace(present_world(self._engine.world, models, lights), gravity=(x, y, z)))

    @journaled
    def reset_models(self) -> None:
        """Reset the present models to their initial state; time continues.

        Plugins restart too, as in Gazebo Classic; sensors continue.
        """
        engine = self._engine
        engine.check_open()
        loaded = self._loaded.snapshot
        self._bus.settle()
        for sensor in engine.structure.all_sensors():
            sensor.take_held()
        _reset_physics(engine, loaded)
        models, plugins = self._handles.tables["model"].values(), engine.structure.all_plugins()
        for handle, state in loaded.handles:
            if handle in models or handle is engine.velocity_servos:
                handle.set_state(state)
        for plugin, state in loaded.plugins:
            if plugin in plugins:
                engine.faults.take_back(plugin, state)
        engine.reschedule()
        for plugin in engine.structure.all_plugins():
            engine.faults.task(plugin, "reset")(0)


def _reset_physics(engine: Engine, loaded: Snapshot) -> None:
    """Reset every model: a loaded model to its first state, a spawned model to its spawn pose.

    Removed models stay removed. Positions, velocities, controls, welds and the poses of static models are set. Forces
    for the next step are dropped.
    """
    model, data, physics = engine.mj_model, engine.mj_data, engine.physics
    for field in _PLACE_FIELDS:
        if field in engine.originals:
            engine.touch(field)[:] = engine.original(field)
    fresh = mujoco.MjData(model)
    place_joints(model, fresh, engine.names.joints.values())
    data.qpos[:], data.qvel[:] = fresh.qpos, 0.0
    data.mocap_pos[:], data.mocap_quat[:] = fresh.mocap_pos, fresh.mocap_quat
    data.ctrl[:], data.eq_active[:] = fresh.ctrl, fresh.eq_active
    data.qacc_warmstart[:] = data.qfrc_applied[:] = 0.0
    data.xfrc_applied[:] = physics.persistent_wrenches
    assert isinstance(loaded.data, mujoco.MjData)  # the loaded state is not compact
    copy_state(loaded.structure.compiled.model, loaded.data, model, data, ("qvel",))
    physics.push_once(False)
    physics.changed_model()
    physics.changed(STALE)
