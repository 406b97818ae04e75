"""Traffic light and level crossing of TurtleBot3's AutoRace course in Gazebo Classic.

Times, poses and names of materials are those of `traffic_light_plugin.cpp` and `traffic_bar_plugin.cpp` in
turtlebot3_simulations, branch humble. Both plugins have no parameters and no topics.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params, Pose

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_S: Final = 1_000_000_000
_LIGHTS: Final = (("traffic_light_red", 5 * _S), ("traffic_light_yellow", _S), ("traffic_light_green", 5 * _S))
"""Materials in their order, with their times [ns]."""

_BAR_TIME: Final = 10 * _S
_BAR_UP: Final = Pose.from_rpy(-0.75, 1.11, 0.275, 0.0, -1.57, -1.57)
_BAR_DOWN: Final = Pose.from_rpy(-0.85, 1.26, 0.125, 0.0, 0.0, -1.57)


class TrafficLight(ModelPlugin):
    """Changes the material of its model's visuals: red for 5 s, yellow for 1 s, green for 5 s, and again.

    The materials `traffic_light_red`, `traffic_light_yellow` and `traffic_light_green` come from the scripts beside the
    texture of the file.
    """

    filenames = ("libtraffic_light_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._materials: dict[str, list[str]] = {}
        for visual in (visual for link in scene.all_links() for visual in link.visuals):
            names = [builder.add_script_material(visual, name) for name, _ in _LIGHTS]
            if all(names):
                self._materials[visual.scoped] = names
        if not self._materials:
            message = f"model {scene.scoped!r} has no visual with the textures of a traffic light; it does not change"
            params.diagnostics.warning(
                "SK-PLUGIN-003", message, self.where, f"a script has {_LIGHTS[0][0]} and its like"
            )

    def load(self, parent: Model, params: Params) -> None:
        self._light, self._since_ns = 0, self.sim.time_ns

    def before_step(self) -> None:
        now = self.sim.time_ns
        if now - self._since_ns >= _LIGHTS[self._light][1]:
            self._light, self._since_ns = (self._light + 1) % len(_LIGHTS), now
            for scoped, names in self._materials.items():
                self.sim.visual(scoped).set_material(names[self._light])


class TrafficBar(ModelPlugin):
    """Opens and closes the bar of the level crossing every 10 s, at its poses on the course; it begins closed.

    As in Gazebo the bar has no gravity, and it jumps from one pose to the other.
    """

    filenames = ("libtraffic_bar_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        for link in scene.all_links():
            body = builder.spec.body(builder.names.link(link.scoped).body_name)
            if not scene.static:
                body.gravcomp = 1.0

    def load(self, parent: Model, params: Params) -> None:
        self._model, self._is_up, self._since_ns = parent, False, self.sim.time_ns

    def before_step(self) -> None:
        now = self.sim.time_ns
        if now - self._since_ns >= _BAR_TIME:
            self._is_up, self._since_ns = not self._is_up, now
            self._model.set_pose(_BAR_UP if self._is_up else _BAR_DOWN)
            if not self._model.static:
                self._model.set_velocity((0.0, 0.0, 0.0))
