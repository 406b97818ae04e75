"""Control of a world as a whole: pause, gravity, collisions, geographic origin, random seed, reset of models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import mujoco
import numpy as np

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
    from simkit.scene import SceneWorld, SphericalCoordinates


class Advance(Protocol):
    """Makes the steps up to a tick."""

    def __call__(self, target: int, *, is_served: bool = False) -> None:
        """Advances to `target`; a run that is served ends earlier where it is told to halt."""


class PauseControl:
    """Where a run is to stop: what pausing, stepping and running to a time mean.

    As with gz's server, it is the one who keeps a world running (`simkit run`) that stands still while the world is
    paused, and goes on when it is resumed. A script that calls `step` or `run` says itself how far to go, as with gz's
    multi-step, and gets there.

    Args:
        engine: that is advanced.
        advance: makes the steps.
        commands: another generation of them tells of a restore or a reset.

    Attributes:
        until: the tick beyond which it does not go by itself; None where it runs on.
        is_stepping: whether it is on its way there by steps that were asked for.
        pace: the highest real-time factor that somebody asked for; None for none. It is no state of the world.
        is_served: whether somebody keeps the world running, so that what is asked for is done by them.
        is_over: whether the run has come to its end, so that `advance` goes no further; no state of the world.
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
        """Whether the world stands still."""
        return self.until is not None and self._engine.tick >= self.until

    def on_change(self, callback: Callable[[], None]) -> None:
        """Calls back whenever somebody pauses the world, resumes it, or asks for steps."""
        self._watchers.append(callback)

    def pause(self) -> None:
        """Has the world stand still, once the step under way is done."""
        self._set(self._engine.tick, is_stepping=False)

    def resume(self) -> None:
        """Lets the world go on."""
        self._set(None, is_stepping=False)

    def step(self, count: int) -> None:
        """Has a world that is paused do so many steps, and pause again; more of them add up."""
        left = self.until - self._engine.tick if self.until is not None and self.is_stepping else 0
        self._set(self._engine.tick + max(0, left) + count, is_stepping=True)

    def run_to(self, time_ns: int) -> None:
        """Has the world go on to the first tick at or after a simulated time [ns], and pause there."""
        clock = self._engine.clock
        tick = clock.ticks(time_ns / 1e9)
        while clock.time_ns(tick) < time_ns:
            tick += 1
        while tick > 0 and clock.time_ns(tick - 1) >= time_ns:
            tick -= 1
        self._set(tick, is_stepping=False)

    def catch_up(self) -> None:
        """Goes where the run is to stop, where nobody else will: outside a step, in a world that nobody serves."""
        engine = self._engine
        if self.until is not None and not self.is_served and not engine.is_stepping and self.until > engine.tick:
            self._advance(self.until)

    @contextmanager
    def served(self) -> Iterator[None]:
        """Says that the world is kept running within."""
        self.is_served = True
        try:
            yield
        finally:
            self.is_served = False

    def end(self) -> None:
        """Has a run that is served end with the step under way."""
        self.is_over = True
        self._engine.loop.halt()

    def advance(self, count: int) -> None:
        """Goes on by up to `count` steps, as far as the world is let: what `simkit run` does again and again.

        It ends where a hook goes back to another time, which may be the one at which it began.
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
_PLACE_FIELDS = ("body_pos", "body_quat")  # of what is fixed or hinged to the world and was moved


class GeographicOrigin:
    """The place of the world's origin; sensors that depend on it (`navsat`, `magnetometer`) are told."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @property
    def place(self) -> SphericalCoordinates | None:
        """The world's `<spherical_coordinates>`; None where there are none."""
        return self._engine.world.spherical_coordinates

    def move(self, place: SphericalCoordinates | None) -> None:
        """Puts the world's origin somewhere else."""
        engine = self._engine
        sensors = [s for s in engine.structure.all_sensors() if hasattr(s, "relocate")]
        for sensor in sensors:
            sensor.take_held()
        engine.world = replace(engine.world, spherical_coordinates=place)
        for sensor in sensors:
            sensor.relocate()

    def get_state(self) -> SphericalCoordinates | None:
        """Returns the place, for a snapshot."""
        return self.place

    def set_state(self, state: SphericalCoordinates | None) -> None:
        """Goes back to a place from `get_state`."""
        if state is not self.place:
            self.move(state)


class WorldControl:
    """What the services of a world do.

    Args:
        engine, communication, handles: of the simulation.
        advance: makes steps.
        loaded: gives the state at the start; raises InputError while the world is still being loaded.

    Attributes:
        pausing: whether the world stands still, and where it is to stop.
        origin: where on its planet the world lies.
        write_sdf: writes a world as SDF text; given from outside, for this room knows no format.
    """

    write_sdf: Callable[[SceneWorld], str] | None = None

    def __init__(
        self, engine: Engine, bus: TopicBus, handles: EntityHandles, advance: Advance, loaded: Callable[[], Snapshot]
    ) -> None:
        self._engine, self._bus, self._handles = engine, bus, handles
        self._advance, self._loaded = advance, loaded
        self.pausing = PauseControl(engine, advance, bus.inbox)
        self.origin = GeographicOrigin(engine)

    # ------------------------------------------------------------------ running

    @property
    def paused(self) -> bool:
        """Whether the world stands still, as its services, `simkit run` and gz understand it; settable.

        A script that calls `step` or `run` says itself how far to go, and gets there all the same.
        """
        return self.pausing.is_paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        if not paused:
            self.pausing.resume()
        elif not self.pausing.is_paused:
            self.pausing.pause()

    def serve(self, target: int) -> None:
        """Advances up to a tick, or until the loop is halted.

        Raises:
            SimulationDiverged, PluginError: as `Simulation.step`.
        """
        self._advance(target, is_served=True)

    @journaled
    def reseed(self, seed: int) -> None:
        """Draws everything random from another seed from now on."""
        self._bus.settle()
        self._engine.streams.reseed(seed)

    # ------------------------------------------------------------------ physics

    @property
    def gravity(self) -> Vector:
        """Acceleration that everything feels [m/s²], world frame, shape (3,); settable at any time."""
        return np.array(self._engine.mj_model.opt.gravity)

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        numbers = np.asarray(value, dtype=float)
        if numbers.shape != (3,) or not np.isfinite(numbers).all():
            raise ValueError(f"gravity takes 3 finite numbers, got {value}")
        engine = self._engine
        for sensor in engine.structure.all_sensors():
            sensor.take_held()  # what was held was measured under the old one
        engine.physics.changed_model()
        engine.mj_model.opt.gravity[:] = numbers
        engine.reschedule()  # whoever counts on it asks to be called

    def enable_collisions(self, links: Iterable[str], enabled: bool, only: str = "") -> None:
        """Lets the collisions of links make contacts, or not; rays see them all the same.

        Args:
            links: scoped names.
            enabled: whether they do.
            only: scoped name of the one collision that is meant; all of the links' where it is empty.
        """
        engine, names = self._engine, self._engine.names
        geoms = [g for link in links for g in names.link(link).geoms if not only or names.geom_owner(g)[1] == only]
        for field in _MASK_FIELDS:
            values = engine.touch(field)
            values[geoms] = engine.original(field)[geoms] if enabled else 0
        engine.physics.changed(STALE)

    # ------------------------------------------------------------------ models

    def to_sdf(self) -> str:
        """The world as SDF text: the models that are there now where they are now, with gravity and lights of now.

        Joints are at zero in it, for SDF has no word for their positions.

        Raises:
            InputError: nothing that writes SDF came with the simulation.
        """
        if self.write_sdf is None:
            raise InputError("nothing that writes SDF came with this simulation")
        models = [(handle.scene, handle.pose) for handle in self._handles.models.values()]
        everything = self._handles.tables["light"].values()
        lights = [(light.scene, light.pose) for light in everything if not light.scene.link]
        x, y, z = self.gravity.tolist()
        return self.write_sdf(replace(present_world(self._engine.world, models, lights), gravity=(x, y, z)))

    @journaled
    def reset_models(self) -> None:
        """Puts the models that are there back to where and how they started; time goes on.

        Plugins start anew too, as they do in Gazebo Classic; sensors go on.
        """
        engine, loaded = self._engine, self._loaded()
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
    """Puts every model back: one that was loaded to its first state, one that was spawned since to where it came.

    What was removed stays away. Positions, velocities, controls, welds and the places of static models are set;
    forces that wait for the next step are dropped.
    """
    model, data, physics = engine.mj_model, engine.mj_data, engine.physics
    for field in _PLACE_FIELDS:
        if field in engine.originals:
            engine.touch(field)[:] = engine.original(field)
    fresh = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = fresh.qpos, 0.0
    data.mocap_pos[:], data.mocap_quat[:] = fresh.mocap_pos, fresh.mocap_quat
    data.ctrl[:], data.eq_active[:] = fresh.ctrl, fresh.eq_active
    data.qacc_warmstart[:] = data.qfrc_applied[:] = 0.0
    data.xfrc_applied[:] = physics.persistent_wrenches
    copy_state(loaded.structure.compiled.model, loaded.data, model, data, ("qvel",))
    physics.one_shot = False
    physics.changed_model()
    physics.changed(STALE)
