"""Models, links, joints, sensors and plugins of a simulation by name, and how they are added and removed while
it runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from simkit.pose import Pose, quat_conjugate, quat_multiply
from simkit.runtime.aspect import Aspect
from simkit.runtime.communication.journal import journaled
from simkit.runtime.engine.physics import STALE
from simkit.runtime.engine.snapshot import take_snapshot
from simkit.runtime.engine.world_structure import WorldStructure
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.light import Light
from simkit.runtime.handles.link import Link
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.visual import Visual
from simkit.runtime.model_copy import check_model_name
from simkit.scene import SceneLink, SceneModel

if TYPE_CHECKING:
    from simkit.runtime.engine.step_loop import StepLoop
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.simulation import Simulation
    from simkit.runtime.spawner import Spawner


def set_weld(sim: Simulation, name: str, closed: bool) -> None:
    """Closes a weld with its bodies as they stand, or lets it go. Raises KeyError.

    The constraint keeps the anchor, a point of the second body, where it is in the first, and their orientations:
    seven numbers of `eq_data` behind the anchor's three.
    """
    number = sim.names.equality(name)
    model, data = sim.mj_model, sim.physics.fresh()
    first, second = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
    if closed:
        one, two = (Pose(data.xpos[b], data.xquat[b]) for b in (first, second))
        row = sim.touch("eq_data")[number]
        row[3:6] = one.inverse().transform(two.transform(row[:3]))
        row[6:10] = quat_multiply(quat_conjugate(one.quaternion), two.quaternion)
    sim.mj_data.eq_active[number] = closed
    for body in (first, second):
        sim.physics.changed_body(STALE, body)


class WorldContents(Aspect):
    """The part of a simulation that knows what is in it.

    Attributes:
        entities: the handles.
    """

    entities: EntityHandles
    _population: Spawner
    _loop: StepLoop

    # ------------------------------------------------------------------ what there is

    @property
    def structure(self) -> WorldStructure:
        """What is in the world now."""
        return self._population.structure

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

    # ------------------------------------------------------------------ spawn and remove

    def spawn(self, source: Any, name: str | None = None, pose: Pose | None = None) -> Model:
        """Adds a model while time goes on; everything else keeps its state and its handles.

        Args:
            source: a file, XML text, or the bare name of a model.
            name: instead of the file's own.
            pose: of the model frame in the world, instead of the file's own.

        Raises:
            LoadError: the source has errors, or the name is taken.
            InputError: no model can have this name.
        """
        return self.spawn_all([(source, name, pose)])[0]

    def spawn_all(self, models: Iterable[tuple[Any, str | None, Pose | None]]) -> list[Model]:
        """Adds several models at once, which takes little longer than one; all of them or none.

        Args:
            models: source, name and pose of each, as for `spawn`.

        Raises:
            LoadError: one of the sources has errors, or its name is taken.
            InputError: no model can have one of the names.
        """
        return self._spawned(list(models))

    @journaled
    def _spawned(self, wanted: list[tuple[Any, str | None, Pose | None]]) -> list[Model]:
        self._whole._check_open()
        for _, name, _ in wanted:
            if name is not None:
                check_model_name(name)
        names = self._population.spawn(wanted)
        self._whole.reschedule()
        return [self.model(name) for name in names]

    @journaled
    def remove(self, name: str) -> None:
        """Takes a top-level model away while time goes on."""
        self._whole._check_open()
        self.model(name)  # an unknown name is a KeyError that tells the closest
        self._population.remove(name)
        self._whole.action_table.abandon_gone()
        self._whole.reschedule()
        self.forget_gone()

    @contextmanager
    def all_or_none(self) -> Iterator[None]:
        """Where something raises within, whatever was spawned, removed or changed within is as before, bit for bit."""
        before = take_snapshot(self._whole)
        try:
            yield
        except Exception:
            self._population.undo(before)
            raise

    @journaled
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
        self._whole._check_open()
        scoped = self._population.add_sensor(name, sensor)
        self._whole.reschedule()
        return self.sensor(scoped)

    def forget_gone(self) -> None:
        """Closes what nothing brings back any more; within a step once that is done, for it may be at work."""
        if self._loop.is_running:
            self._loop.promise(self._population.forget)
        else:
            self._population.forget()

    @journaled
    def make_movable(self, name: str) -> None:
        """Lets a static top-level model be moved: its links become bodies that follow their set pose."""
        if self._population.make_movable(name):
            self._whole.reschedule()

    @journaled
    def add_weld(self, name: str, parent_link: str, child_link: str) -> None:
        """Adds a weld between two links while time goes on; `set_weld` closes it. Raises KeyError for unknown links."""
        self._population.add_weld(name, parent_link, child_link)
        self._whole.reschedule()

    @journaled
    def set_weld(self, name: str, closed: bool) -> None:
        """Closes a weld with its links as they stand now, or lets it go. Raises KeyError."""
        set_weld(self._whole, name, closed)

    @property
    def models_reader(self) -> Callable[..., SceneModel]:
        """Reads models that come while it runs, given `(source, diagnostics, *, name, pose, taken)`; settable."""
        return self._population._load_model

    @models_reader.setter
    def models_reader(self, reader: Callable[..., SceneModel]) -> None:
        self._population._load_model = reader

    def adopt(self, structure: WorldStructure) -> None:
        """Goes on with a structure that was before, with all its state still to be put back."""
        self._population.adopt(structure)
