"""Control of a world as a whole: pause, gravity, collisions, geographic origin, copies of models, reset of models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.errors import InputError
from simkit.pose import Pose, Vector
from simkit.runtime.aspect import Aspect
from simkit.runtime.communication.journal import journaled
from simkit.runtime.communication.on_demand_tasks import OnDemandTasks
from simkit.runtime.engine.model_reset import reset_models
from simkit.runtime.engine.pause_control import PauseControl
from simkit.runtime.engine.physics import STALE
from simkit.runtime.engine.step_loop import guarded_hook
from simkit.runtime.model_copy import check_model_name, copy_model, present_world

if TYPE_CHECKING:
    from simkit.runtime.handles.model import Model
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SceneWorld, SphericalCoordinates


_MASK_FIELDS = ("geom_contype", "geom_conaffinity")


def enable_collisions(sim: Simulation, links: Iterable[str], enabled: bool, only: str = "") -> None:
    """Lets the collisions of links make contacts, or not; rays see them all the same.

    Args:
        sim: the simulation.
        links: scoped names.
        enabled: whether they do.
        only: scoped name of the one collision that is meant; all of the links' where it is empty.
    """
    names = sim.names
    geoms = [g for link in links for g in names.link(link).geoms if not only or names.geom_owner(g)[1] == only]
    for field in _MASK_FIELDS:
        values = sim.touch(field)
        values[geoms] = sim.original(field)[geoms] if enabled else 0
    sim.physics.changed(STALE)


class GeographicOrigin:
    """The place of the world's origin; sensors that depend on it (`navsat`, `magnetometer`) are told."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim

    @property
    def place(self) -> SphericalCoordinates | None:
        """The world's `<spherical_coordinates>`; None where there are none."""
        return self._sim.world.spherical_coordinates

    def move(self, place: SphericalCoordinates | None) -> None:
        """Puts the world's origin somewhere else."""
        sim = self._sim
        sensors = [s for s in sim.structure.all_sensors() if hasattr(s, "relocate")]
        for sensor in sensors:
            sensor.take_held()
        sim.world = replace(sim.world, spherical_coordinates=place)
        for sensor in sensors:
            sensor.relocate()

    def get_state(self) -> SphericalCoordinates | None:
        return self.place

    def set_state(self, state: SphericalCoordinates | None) -> None:
        if state is not self.place:
            self.move(state)


class WorldControl(Aspect):
    """The part of a simulation behind the services of its world.

    Attributes:
        pausing: whether the world stands still, and where it is to stop.
        on_demand: work that is scheduled only while somebody wants it.
        site: where on its planet the world lies.
        write_sdf: writes a world as SDF text; given from outside, for this room knows no format.
    """

    write_sdf: Callable[[SceneWorld], str] | None = None

    def open_world(self, sim: Simulation) -> None:
        """Makes the parts, for a world that runs on."""
        self.pausing, self.on_demand, self.site = PauseControl(sim), OnDemandTasks(sim), GeographicOrigin(sim)

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
        """Advances up to a tick, or until `halt`: what `pausing` makes the steps of a world that is kept running with.

        Raises:
            SimulationDiverged, PluginError: as `step`.
        """
        self._whole._advance(target, is_served=True)

    def halt(self) -> None:
        """Ends the present stretch of a world that is kept running with the step under way; `step` and `run` go on."""
        self._whole._loop.halt()

    @journaled
    def reseed(self, seed: int) -> None:
        """Draws everything random from another seed from now on."""
        sim = self._whole
        sim.bus.settle()
        sim.seed = seed
        sim.streams.reseed(seed)

    # ------------------------------------------------------------------ gravity

    @property
    def gravity(self) -> Vector:
        """Acceleration that everything feels [m/s²], world frame, shape (3,); settable at any time."""
        return np.array(self._whole.mj_model.opt.gravity)

    @gravity.setter
    def gravity(self, value: Sequence[float] | Vector) -> None:
        numbers = np.asarray(value, dtype=float)
        if numbers.shape != (3,) or not np.isfinite(numbers).all():
            raise ValueError(f"gravity takes 3 finite numbers, got {value}")
        sim = self._whole
        for sensor in sim.structure.all_sensors():
            sensor.take_held()  # what was held was measured under the old one
        sim.physics.changed_model()
        sim.mj_model.opt.gravity[:] = numbers
        sim.reschedule()  # whoever counts on it asks to be called

    # ------------------------------------------------------------------ models

    @journaled
    def clone(self, name: str, new_name: str, pose: Pose | None = None) -> Model:
        """Adds a copy of a top-level model as its file has it, where the model is now or at a pose in the world.

        Raises:
            KeyError: there is no such model; names the closest.
            InputError: there is a model of the new name, no model can have that name, or the model is of a kind that
                cannot be copied.
        """
        sim = self._whole
        scene = sim.model(name).scene
        check_model_name(new_name)
        if new_name in sim.models:
            raise InputError(f"SK-LOAD-011 there is a model {new_name!r} already", "SK-LOAD-011")
        return sim.spawn(copy_model(scene, new_name, sim.model(name).pose if pose is None else pose))

    def name_in_file(self, source: Any) -> str:
        """The name that a model to be spawned has in its own file. Raises LoadError."""
        return self._whole._population.read(source).name

    def pose_in_file(self, source: Any) -> Pose:
        """The pose in the world that a model to be spawned has in its own file. Raises LoadError."""
        return self._whole._population.read(source).pose_world

    def to_sdf(self) -> str:
        """The world as SDF text: the models that are there now where they are now, with gravity and lights of now.

        Joints are at zero in it, for SDF has no word for their positions.

        Raises:
            InputError: nothing that writes SDF came with the simulation.
        """
        sim = self._whole
        if self.write_sdf is None:
            raise InputError("nothing that writes SDF came with this simulation")
        models = [(handle.scene, handle.pose) for handle in sim.models.values()]
        lights = [(light.scene, light.pose) for light in sim.lights.values() if not light.scene.link]
        x, y, z = sim.gravity.tolist()
        return self.write_sdf(replace(present_world(sim.world, models, lights), gravity=(x, y, z)))

    def enable_collisions(self, links: Iterable[str], enabled: bool, only: str = "") -> None:
        """Lets the collisions of links (scoped names) make contacts, or not; of one collision where `only` names it."""
        enable_collisions(self._whole, links, enabled, only)

    @journaled
    def reset_models(self) -> None:
        """Puts the models that are there back to where and how they started; time goes on.

        Plugins start anew too, as they do in Gazebo Classic; sensors go on.
        """
        sim = self._whole
        sim._check_loaded()
        reset_models(sim, sim._loaded)
        sim.reschedule()
        for plugin in sim.structure.all_plugins():
            guarded_hook(sim, plugin, "reset")()
