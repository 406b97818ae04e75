"""Touch detector of Gazebo Classic, `libTouchPlugin.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, cast

from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.gz.touch import TouchOptions, TouchTimer
from simkit.plugins.options import OptionsOf, text

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel
    from simkit.sensors.devices.contact import Contact


class ClassicTouchPluginOptions(TouchOptions):
    """Options of `ClassicTouchPlugin`."""

    sensor: str = text(required=True)


class ClassicTouchPlugin(TouchTimer):
    """Publishes one message after its model has touched the target, and nothing else, for an uninterrupted time.

    Only the collisions of the named contact sensors count. The messages are integers: 1 on `/<namespace>/enable` starts
    the detection, 0 stops it; 1 on `/<namespace>/touched` reports the touch.
    """

    endpoints = (
        publishes("{namespace}/touched", "std_msgs/msg/Int32"),
        listens("{namespace}/enable", "std_msgs/msg/Int32"),
    )
    options = OptionsOf(ClassicTouchPluginOptions)
    filenames = ("libTouchPlugin.so",)
    message_type: ClassVar[str] = "std_msgs/msg/Int32"
    is_exclusive: ClassVar[bool] = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._read_common(scene, params, builder)
        _ = self.options.sensor
        sensors = {s.scoped: s.name for s in scene.all_sensors() if s.kind == "contact"}
        self._sensors: tuple[str, ...] = ()
        for element in params.all("sensor"):
            matching = tuple(scoped for scoped in sensors if f"::{scoped}".endswith(f"::{element.value}"))
            self._sensors += matching
            if not matching:
                listed = ", ".join(map(repr, sensors.values())) or "none"
                message = f"model {scene.scoped!r} has no contact sensor {element.value!r}; it has: {listed}"
                element.error("SK-PLUGIN-003", message, did_you_mean(element.value, sensors.values()))

    def load(self, parent: Model, params: Params) -> None:
        sensors = cast("list[Contact]", [self.sim.sensor(scoped) for scoped in self._sensors])
        self._watch([name for sensor in sensors for name in sensor.collisions], params)
