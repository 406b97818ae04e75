"""Control of a world as a whole: pause, gravity, collisions, geographic origin, random seed, reset of models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.compiler.state_transfer import copy_state
from simkit.errors import InputError
from simkit.pose import Vector
from simkit.runtime.communication.journal import journaled
from simkit.runtime.engine.pause_control import Advance, PauseControl
from simkit.runtime.engine.physics_state import STALE
from simkit.runtime.model_copy import present_world

if TYPE_CHECKING:
    from simkit.runtime.communication.communication import Communication
    from simkit.runtime.communication.journal import Journal
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.snapshot import Snapshot
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.scene import SceneWorld, SphericalCoordinates

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
        self,
        engine: Engine,
        communication: Communication,
        handles: EntityHandles,
        advance: Advance,
        loaded: Callable[[], Snapshot],
    ) -> None:
        self._engine, self._bus, self._handles = engine, communication.bus, handles
        self._advance, self._loaded = advance, loaded
        self.pausing = PauseControl(engine, advance, communication.bus.inbox)
        self.origin = GeographicOrigin(engine)

    @property
    def _journal(self) -> Journal | None:
        return self._bus.journal

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
    copy_state(loaded.structure.compiled.model, loaded.data, model, data)
    physics.one_shot = False
    physics.changed_model()
    physics.changed(STALE)
