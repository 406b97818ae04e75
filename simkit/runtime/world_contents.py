"""Models, links, joints, sensors and plugins of a simulation by name, and their changes during the run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

from simkit.errors import InputError
from simkit.memory_error import memory_errors
from simkit.pose import Pose, checked_pose, quat_conjugate, quat_multiply
from simkit.runtime.communication.journal import journaled
from simkit.runtime.engine.physics_state import STALE
from simkit.runtime.handles.entity_handles import EntityHandles
from simkit.runtime.handles.light import Light
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.visual import Labels, Temperatures
from simkit.runtime.model_copy import check_model_name, copy_model
from simkit.runtime.spawner import Spawner, SpawnRequest
from simkit.runtime.world_source import ModelLoader, WorldSource
from simkit.scene import SceneLink

if TYPE_CHECKING:
    from simkit.extend import Plugin, Sensor
    from simkit.runtime.communication.communication import Communication
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.snapshot import Snapshots


class WorldContents:
    """Content of a simulation.

    Args:
        sim: simulation of the sensors and plugins.
        engine: engine of the simulation.
        communication: communication of the simulation.
        snapshots: functions that take and restore the state of the simulation.
        source: functions that read the models to spawn.

    Attributes:
        handles: handles of models, links, joints, lights and sensors.
        spawner: function object that adds and removes models.
    """

    def __init__(
        self,
        sim: object,
        engine: Engine,
        communication: Communication,
        snapshots: Snapshots,
        source: WorldSource,
    ) -> None:
        self._engine, self._communication, self._bus = engine, communication, communication.bus
        self.handles = EntityHandles(engine, self.make_movable)
        self.spawner = Spawner(sim, engine, communication, self.handles, snapshots, source)

    # ------------------------------------------------------------------ lists

    @property
    def open_handles(self) -> EntityHandles:
        """Handles of the simulation; an error if the simulation is closed."""
        self._engine.check_open()
        return self.handles

    @property
    def models(self) -> dict[str, Model]:
        """Top-level models by name."""
        return dict(self.handles.models)

    @property
    def lights(self) -> dict[str, Light]:
        """Lights by scoped name."""
        return dict(self.handles.tables["light"])

    @property
    def sensors(self) -> dict[str, Sensor[Any]]:
        """Sensors by scoped name."""
        return dict(self.handles.tables["sensor"])

    @property
    def plugins(self) -> dict[str, Plugin]:
        """Plugins by scoped name, `robot::drive`; those of the world by their own name.

        The first of equal names counts.
        """
        by_name: dict[str, Plugin] = {}
        for plugin in self._engine.structure.all_plugins():
            name = f"{plugin.scoped}::{plugin.name}" if plugin.scoped else plugin.name
            by_name.setdefault(name, cast("Plugin", plugin))  # the runtime itself knows only `AttachedPlugin`
        return by_name

    @property
    def labels(self) -> Labels:
        """Labels for segmentation and bounding box cameras, by scoped name of a model or a visual."""
        return self.handles.labels

    @property
    def temperatures(self) -> Temperatures:
        """Temperatures for thermal cameras, by scoped name of a model, a link or a visual."""
        return self.handles.temperatures

    def has_sensor(self, name: str) -> bool:
        """Check whether a sensor of that name is simulated."""
        return name in self.handles.tables["sensor"]

    def scene_link(self, scoped: str) -> SceneLink:
        """Return the description of a link from the file of the world or model."""
        return self.handles.scene_link(scoped)

    # ------------------------------------------------------------------ spawn and remove

    @memory_errors()
    def spawn_all(self, models: Iterable[SpawnRequest]) -> list[Model]:
        """Add several models in one operation, which takes little longer than adding one. If one fails, none is added.

        Args:
            models: source, name and pose of each model, as for `Simulation.spawn`.

        Raises:
            LoadError: a source has errors, or its name is already used.
            InputError: no model can have one of the names.
        """
        return self._spawned(list(models))

    @journaled
    def _spawned(self, wanted: list[SpawnRequest]) -> list[Model]:
        self._engine.check_open()
        for _, name, pose in wanted:
            if name is not None:
                check_model_name(name)
            if pose is not None:
                checked_pose(pose)
        names = self.spawner.spawn(wanted)
        self._engine.reschedule()
        return [self.handles.model(name) for name in names]

    @journaled
    def remove(self, name: str) -> None:
        """Remove a top-level model during the run."""
        self._engine.check_open()
        self.handles.model(name)  # raises KeyError for an unknown name
        self.spawner.remove(name)
        self._communication.services.abandon_gone()
        self._communication.actions.abandon_gone()
        self._engine.reschedule()
        self.spawner.forget_gone()

    @journaled
    def clone(self, name: str, new_name: str, pose: Pose | None = None) -> Model:
        """Add a copy of a top-level model, as described by its file.

        Args:
            name: name of the model.
            new_name: name of the copy.
            pose: pose in the world; None for the present pose of the model.

        Raises:
            KeyError: no such model; the message suggests the closest name.
            InputError: the new name is already used or invalid, or a model of this kind cannot be copied.
        """
        model = self.handles.model(name)
        check_model_name(new_name)
        if new_name in self.handles.models:
            raise InputError("SK-LOAD-011", f"a model {new_name!r} exists already")
        copied = copy_model(model.scene, new_name, model.pose if pose is None else pose)
        return self.spawn_all([(copied, None, None)])[0]

    @contextmanager
    def all_or_none(self) -> Iterator[None]:
        """Undo all spawns, removals and changes within the context, bit for bit, if an exception is raised in it."""
        before = self.spawner.snapshots.take()
        try:
            yield
        except Exception:
            self.spawner.undo(before)
            raise

    @journaled
    def add_sensor(self, name: str, sensor: str | Mapping[str, object]) -> Sensor[Any]:
        """Add a sensor to a link or a joint during the run; no other output changes in any bit.

        Snapshots, resets and removals include the sensor. It is removed with its model, and by a reset or restore to an
        earlier time.

        Args:
            name: scoped name of the link or joint.
            sensor: `<sensor>` element as XML text or as a dict: `{"name": "imu", "type": "imu", "update_rate": 100,
                "imu": {…}}`.

        Returns:
            The sensor.

        Raises:
            LoadError: the sensor has errors.
            KeyError: no such link or joint; the message suggests the closest name.
            InputError: the link or joint has a sensor of that name.
        """
        self._engine.check_open()
        scoped = self.spawner.add_sensor(name, sensor)
        self._engine.reschedule()
        added: Sensor[Any] = self.handles.find("sensor", scoped)
        return added

    @journaled
    def make_movable(self, name: str) -> None:
        """Make a static top-level model movable: its links become mocap bodies, which stay at the pose that is set."""
        if self.spawner.make_movable(name):
            self._engine.reschedule()

    @property
    def models_reader(self) -> ModelLoader:
        """Function that reads models to spawn, called as `(source, diagnostics, *, name, pose, taken)`; settable."""
        return self.spawner.load_model

    @models_reader.setter
    def models_reader(self, reader: ModelLoader) -> None:
        self.spawner.load_model = reader

    def name_in_file(self, source: object) -> str:
        """Return the name of a model in its file.

        Raises:
            LoadError: the source has errors.
        """
        return self.spawner.read(source).name

    def pose_in_file(self, source: object) -> Pose:
        """Return the world pose that the file of a model gives.

        Raises:
            LoadError: the source has errors.
        """
        return self.spawner.read(source).pose_world

    # ------------------------------------------------------------------ frames

    @journaled
    def set_sensor_frame(self, name: str, frame: str) -> None:
        """Set the frame of a sensor's messages.

        Args:
            name: scoped name of the sensor.
            frame: name of the frame.

        Raises:
            KeyError: the sensor does not exist.
        """
        self.open_handles.find("sensor", name).set_frame_id(frame)

    # ------------------------------------------------------------------ welds

    @journaled
    def add_weld(self, name: str, parent_link: str, child_link: str) -> None:
        """Add a weld between two links during the run. The weld is open, so has no effect, until `set_weld` closes it.

        Raises:
            KeyError: a link does not exist.
        """
        self.spawner.add_weld(name, parent_link, child_link)
        self._engine.reschedule()

    @journaled
    def set_weld(self, name: str, closed: bool) -> None:
        """Close a weld with its links at their present poses, or open it.

        A closed weld keeps a point of the second body, the anchor, at its present position in the first body. It also
        keeps the relative orientation. `eq_data` holds the anchor (3 numbers), then this position and this orientation
        (7 numbers).

        Raises:
            KeyError: no such weld.
        """
        engine = self._engine
        number = engine.names.equality(name)
        model, data = engine.mj_model, engine.physics.fresh()
        first, second = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
        if closed:
            parent, child = (Pose(data.xpos[b], data.xquat[b]) for b in (first, second))
            row = engine.touch("eq_data")[number]
            row[3:6] = parent.inverse().transform(child.transform(row[:3]))
            row[6:10] = quat_multiply(quat_conjugate(parent.quaternion), child.quaternion)
        engine.mj_data.eq_active[number] = closed
        for body in (first, second):
            engine.physics.changed_body(STALE, body)
