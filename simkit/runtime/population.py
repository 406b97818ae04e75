"""What is in a simulation, and how that changes while it runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics
from simkit.errors import InputError, PluginError, SimkitError
from simkit.pose import Pose
from simkit.runtime.entities import carry_fields
from simkit.runtime.overlap import soften
from simkit.runtime.parts import Parts, Structure, awake_bodies
from simkit.scene import SceneModel

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

ModelLoader = Callable[..., tuple[SceneModel, Diagnostics]]
PartsMaker = Callable[..., Parts]


class Population:
    """The structure of the moment, with its sensors and plugins at work.

    Args:
        sim: whose.
        load_model: reads a model to be spawned.
        make_parts: makes the sensors and plugins of a model and prepares a spec for them.

    Attributes:
        structure: what is there now; never changed, only replaced.
        loaded_plugins: every plugin ever loaded; a restore may bring back one of a removed model.
    """

    def __init__(self, sim: Simulation, load_model: ModelLoader, make_parts: PartsMaker) -> None:
        self._sim, self._load_model, self._make_parts = sim, load_model, make_parts
        self._attached: set[Any] = set()
        self.loaded_plugins: list[Any] = []
        self.structure: Structure

    def spawn(self, source: Any, name: str | None, pose: Pose | None) -> str:
        """Adds a model; returns its name. Where it fails, all is as before."""
        sim, old = self._sim, self.structure
        scene, found = self._load_model(source, name=name, pose=pose, taken=set(old.models))
        before = sim.snapshot()
        builder = old.builder.copy()
        builder.add_model(scene)
        parts = self._make_parts(scene, builder, found)
        found.raise_if_errors()
        compiled = builder.recompile(old.compiled, sim.mj_data)
        models, all_parts = {**old.models, scene.name: scene}, {**old.parts, scene.name: parts}
        self.switch(Structure(builder, compiled, models, old.movable, all_parts))
        try:
            self.start([parts], found)
        except SimkitError:
            sim.restore(before)
            raise
        # a new schedule asks every sensor when it is due, so they have been started
        own = {link.scoped for link in scene.all_links()}
        soften(sim, {g for n, link in compiled.names.links.items() if n in own for g in link.geoms})
        sim.reports.extend(found)
        return scene.name

    def remove(self, name: str) -> None:
        """Takes a top-level model away."""
        old = self.structure
        if name not in old.models:
            raise InputError(f"{name!r} is not a top-level model; remove {name.split('::')[0]!r}", "SK-NAME-003")
        builder = old.builder.copy()
        builder.remove_model(name)
        compiled = builder.recompile(old.compiled, self._sim.mj_data)
        models = {k: v for k, v in old.models.items() if k != name}
        parts = {k: v for k, v in old.parts.items() if k != name}
        self.switch(Structure(builder, compiled, models, old.movable - {name}, parts))

    def make_movable(self, name: str) -> bool:
        """Makes the links of a static model bodies that follow their set pose; False where they are already."""
        old = self.structure
        if name in old.movable:
            return False
        builder = old.builder.copy()
        builder.remove_model(name)
        builder.add_model(old.models[name], movable=True)
        for sensor in old.parts[name].sensors:
            sensor.build(builder)
        compiled = builder.recompile(old.compiled, self._sim.mj_data)
        self.switch(Structure(builder, compiled, old.models, old.movable | {name}, old.parts))
        for light in self._sim.lights.values():
            if light.scene.link.startswith(f"{name}::"):
                self._sim.place_light(light)  # it was drawn in the world's body, and is in its link's own now
        return True

    def add_weld(self, name: str, parent_link: str, child_link: str) -> None:
        """Adds a weld, let go at first, between two links."""
        old = self.structure
        builder = old.builder.copy()
        builder.add_weld(name, parent_link, child_link, active=False)
        compiled = builder.recompile(old.compiled, self._sim.mj_data)
        self.switch(Structure(builder, compiled, old.models, old.movable, old.parts))

    def switch(self, structure: Structure) -> None:
        """Goes on with another structure, the changed model fields carried over."""
        sim = self._sim
        old_model, fields = sim.mj_model, dict(sim.originals)
        new = structure.compiled.model
        sim.originals.clear()
        for field in fields:
            sim.originals[field] = getattr(new, field).copy()
        carry_fields(old_model, new, fields)
        new.opt.gravity[:] = old_model.opt.gravity
        self.adopt(structure)

    def adopt(self, structure: Structure) -> None:
        """Binds handles, sensors and topics to a structure."""
        sim, compiled = self._sim, structure.compiled
        sim.bus.settle()
        staying = set(structure.all_sensors())
        for sensor in self.structure.all_sensors() if self._attached else ():
            if sensor in self._attached and sensor not in staying:
                sensor.leave()
        self.structure = structure
        sim.physics.rebind(compiled.model, compiled.data)
        sim.physics.sleep.restrict(awake_bodies(structure))
        sim.physics.hears_controls = any(n.mjcf for m in structure.models.values() for n in m.all_models())
        sim.entities.bind(structure)
        sim.labels.bind(structure)
        sim.temperatures.bind(structure)
        sim.stand_wrenches(are_applied=True)
        sim.set_active([*structure.all_sensors(), *structure.all_plugins()])
        for sensor in structure.all_sensors():
            if sensor in self._attached:
                sensor.bind(compiled)

    def start(self, parts: list[Parts], diagnostics: Diagnostics) -> None:
        """Attaches new sensors, then loads new plugins, in document order; raises LoadError where they found errors."""
        sim = self._sim
        for part in parts:
            for sensor in part.sensors:
                with sim.bus.owned_by(sensor):
                    sensor.attach(sim)
                self._attached.add(sensor)
                sensor.bind(self.structure.compiled)
        for part in parts:
            for plugin, parent_of in part.plugins:
                with sim.bus.owned_by(plugin):
                    self._load_plugin(plugin, parent_of(sim))
        diagnostics.raise_if_errors()

    def _load_plugin(self, plugin: Any, parent: Any) -> None:
        try:
            plugin._setup(self._sim, plugin.source)
            plugin.load(parent, plugin.params)
        except SimkitError:
            raise
        except Exception as error:
            raise PluginError(plugin.name, "load", self._sim.time, str(plugin.where), repr(error)) from error
        plugin._remember_loaded()
        self.loaded_plugins.append(plugin)
