"""Models, links, joints, sensors, lights and contacts of a simulation, as a script reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar, cast, overload

from simkit.runtime.contact.collision_contacts import Contact, list_contacts
from simkit.runtime.contact.rim_slip import WheelSlip, list_wheel_slips
from simkit.runtime.handles.find_sensor import checked_class, find_sensor

if TYPE_CHECKING:
    from simkit.extend import Plugin, Sensor
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.handles.joint import Joint
    from simkit.runtime.handles.light import Light
    from simkit.runtime.handles.link import Link
    from simkit.runtime.handles.model import Model
    from simkit.runtime.handles.visual import Visual
    from simkit.runtime.world_contents import WorldContents

S = TypeVar("S")


class ScriptEntities:
    """Entities of the world by name: a base class of a simulation.

    Attributes:
        engine: physics, step loop, servos, random streams, plugin faults.
        contents: models, links, joints, sensors and plugins, with functions to add and remove them.
    """

    engine: Engine
    contents: WorldContents

    @property
    def models(self) -> dict[str, Model]:
        """Top-level models by name."""
        self.engine.check_open()
        return self.contents.models

    def model(self, name: str) -> Model:
        """Return a model by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.model(name)

    def link(self, name: str) -> Link:
        """Return a link by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.link(name)

    def joint(self, name: str) -> Joint:
        """Return a joint by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.joint(name)

    @property
    def sensors(self) -> dict[str, Sensor[Any]]:
        """All sensors by scoped name, also those of nested models."""
        self.engine.check_open()
        return self.contents.sensors

    @overload
    def sensor(self, name: str) -> Sensor[Any]: ...

    @overload
    def sensor(self, name: str, type: type[S]) -> S: ...

    def sensor(self, name: str, type: type | None = None) -> object:
        """Return a sensor by scoped name, or by its last name if only one sensor has it.

        Args:
            name: scoped name, such as `"turtlebot3::base_scan::lds"`, or last name, such as `"lds"`.
            type: class that the sensor must have, such as `simkit.sensors.Lidar`; type checkers then know its readings.

        Raises:
            KeyError: no sensor has the name (the message suggests the closest one), or several have it (the message
                lists them).
            InputError: SK-NAME-007 the sensor is of another class.
        """
        sensor = find_sensor(self.contents.open_handles.tables["sensor"], name)
        return sensor if type is None else checked_class(sensor, type)

    def light(self, name: str) -> Light:
        """Return a light by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.light(name)

    def visual(self, name: str) -> Visual:
        """Return a visual by scoped name; a KeyError suggests the closest name."""
        return self.contents.open_handles.find_visual(name)

    def contacts(self, model: Model | str | None = None) -> list[Contact]:
        """Return the contacts of a model, also with itself, or of all; a KeyError suggests the closest name."""
        return list_contacts(self.engine.compiled, self.engine.physics.awake_data(), self._scoped(model))

    def wheel_slips(self, model: Model | str | None = None) -> list[WheelSlip]:
        """Return the true slip of the wheels of a model, or of all; a KeyError suggests the closest name."""
        return list_wheel_slips(self.engine.compiled, self.engine.physics.awake_data(), self._scoped(model))

    def _scoped(self, model: Model | str | None) -> str | None:
        return None if model is None else self.model(cast("str", getattr(model, "scoped", model))).scoped

    @property
    def plugins(self) -> dict[str, Plugin]:
        """Plugins by scoped name, `robot::drive`; those of the world by their own name."""
        self.engine.check_open()
        return self.contents.plugins
