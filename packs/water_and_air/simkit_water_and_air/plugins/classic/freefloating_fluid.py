"""Water for floating robots in Gazebo Classic: `libfreefloating_gazebo_fluid.so` of freefloating_gazebo.

Parameters and topics are those of `freefloating_gazebo_fluid.cpp`, also of its branch of usv_sim_lsa. The forces are
those of `simkit_water_and_air.plugins.fluids.freefloating_link`.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, WorldPlugin, msgs
from simkit.extend import Options, OptionsOf, listens, number, publishes, text, vector3, without_effect
from simkit.linear_algebra import matmul
from simkit.pose import quat_conjugate, quat_rotate
from simkit_water_and_air.message_fields import xyz
from simkit_water_and_air.plugins.fluids.freefloating_link import FreefloatingLink, read_freefloating_link
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.tuple_vectors import to_link_axes, to_world_axes
from simkit_water_and_air.plugins.fluids.water_current import VECTOR, current_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    import mujoco

    from simkit import Simulation
    from simkit.extend import SceneLink, SceneModel, SceneWorld, SpecBuilder, Vector
    from simkit.msgs import Message

_ODOMETRY, _POINT = "nav_msgs/msg/Odometry", "geometry_msgs/msg/Point"
_NS: Final = 1_000_000_000


class FreefloatingFluidOptions(Options):
    """Options of `FreefloatingFluid`."""

    surface: tuple[float, float, float] = vector3(unit="m")
    topic: str = text("current", element="fluidTopic")
    period: float = number(0.0, "s", element="updateRate", minimum=0.0, maximum=1e9)
    description: bool = without_effect(element="descriptionParam")
    always_on: bool = without_effect(element="alwaysOn")


class FreefloatingFluid(WorldPlugin):
    """Lifts and brakes the links of all models that have `<buoyancy>` or `<fluid>` in their URDF file.

    Without `<surface>` the whole world is water. The current is a `Vector3` on `<fluidTopic>` in the namespace
    `gazebo`. `/<model>/state` has the true pose and twist of each model that moves, at most every `<updateRate>` [s].
    A `Point` on `/<model>/Surface/<link>` sets the height of the water at a link.
    """

    endpoints = (
        listens("/gazebo/{fluidTopic}", VECTOR, named_by=("fluidTopic",)),
        listens("/{model}/Surface/{link}", _POINT),
        publishes("/{model}/state", _ODOMETRY),
    )
    options = OptionsOf(FreefloatingFluidOptions)
    filenames = ("libfreefloating_gazebo_fluid.so",)
    reads_at_load = ("inertial",)

    def prepare(self, scene: SceneWorld, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._gravity = abs(float(scene.gravity[2]))
        self._wet: dict[str, FreefloatingLink] = {}
        self._read(link for model in scene.models for link in model.all_links())

    def load(self, parent: Simulation, params: Params) -> None:
        topic = self.options.topic
        self._surface = self.options.surface[2] if params.has("surface") else None
        self._current = np.zeros(3)
        self._links: PushedLinks | None = None
        self._states = {name: self.advertise(f"/{name}/state", _ODOMETRY) for name in self._moving_models()}
        self._due_ns = 0
        for name in self._wet:
            self._listen_to_surface(name)
        self.listen(topic if topic.startswith("/") else f"/gazebo/{topic}", VECTOR, self._on_current)

    def _read(self, links: Iterable[SceneLink]) -> list[str]:
        """Read the elements of new links, and return their names."""
        new = []
        for link in links:
            if link.plugin_elements and link.scoped not in self._wet:
                wet = read_freefloating_link(link, self._gravity)
                if wet is not None:
                    self._wet[link.scoped] = wet
                    new.append(link.scoped)
        return new

    def _moving_models(self) -> dict[str, SceneModel]:
        return {name: model.scene for name, model in self.sim.models.items() if not model.scene.static}

    def _listen_to_surface(self, link: str) -> None:
        model, name = link.split("::")[0], link.rsplit("::", 1)[-1]
        self.listen(f"/{model}/Surface/{name}", _POINT, partial(self._on_surface, link))

    # ------------------------------------------------------------------ commands

    def _on_current(self, message: Message) -> None:
        current = current_of(message)
        if current is None:
            self._once.not_finite("a current")
        else:
            self._current = np.array(current)

    def _on_surface(self, link: str, message: Message) -> None:
        place = current_of(message)
        if place is None:
            self._once.not_finite("a height of the water")
        elif link in self._wet:
            self._wet[link].surface = place[2]

    def surface_at(self, link: str) -> float | None:
        """Return the height of the water at a link [m]; None if the whole world is water."""
        wet = self._wet.get(link)
        return self._surface if wet is None or wet.surface is None else wet.surface

    # ------------------------------------------------------------------ forces

    def _bind(self) -> PushedLinks:
        """Find the links in the present compiled model, after models were spawned or removed."""
        models = self._moving_models()
        present = {link.scoped for scene in models.values() for link in scene.all_links()}
        self._wet = {name: wet for name, wet in self._wet.items() if name in present}
        for name in self._read(link for scene in models.values() for link in scene.all_links()):
            self._listen_to_surface(name)
        self._states = {name: self._states.get(name) or self.advertise(f"/{name}/state", _ODOMETRY) for name in models}
        self._links = PushedLinks(self.sim, tuple(self._wet))
        return self._links

    def before_step(self) -> None:
        """Apply the forces of the water and the wind for the next step."""
        links = self._links
        if links is None or not links.is_current:
            links = self._bind()
        if not len(links):
            return
        data = moving_data(self.sim)
        velocities, axes = links.velocities(data), links.axes(data)
        forces, torques = np.zeros((len(links), 3)), np.zeros((len(links), 3))
        for row, name in enumerate(links.names):
            forces[row], torques[row] = self._load(name, data, links.ids[row], velocities[row], axes[row])
        links.push(data, forces, torques)

    def _load(self, name: str, data: mujoco.MjData, body: int, velocity: Vector, axes: Vector) -> tuple[Vector, Vector]:
        """Return the force [N] at the centre of mass and the torque [N·m] on one link, in world axes."""
        wet, surface = self._wet[name], self.surface_at(name)
        centre = data.xpos[body] + matmul(axes, wet.centre)
        height = -np.inf if surface is None else float(centre[2]) - surface
        water = self._current if wet.moves_with_water else np.zeros(3)
        spin = matmul(data.cvel[body, :3], axes)
        moved = wet.wrench(np.concatenate((matmul(velocity - water, axes), spin)), self.period)
        force = matmul(axes, moved[:3])
        force[2] += wet.lift * wet.share(height)
        torque = matmul(axes, moved[3:]) + np.cross(centre - data.xipos[body], force)
        if wet.is_in_wind and surface is not None:
            through = velocity - np.array(self.sim.engine.wind.at(self.sim.tick))
            rows = axes.reshape(9).tolist()
            ahead, aside, _ = to_link_axes(rows, through.tolist())
            x, y, heel, turn = wet.wind_wrench(ahead, aside, height)
            force = force + np.array(to_world_axes(rows, (x, y, 0.0)))
            torque += np.array(to_world_axes(rows, (heel, 0.0, turn)))
        return force, torque

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Publish the states of the models, if they are due."""
        if self.sim.time_ns < self._due_ns:
            return
        self._due_ns = self.sim.time_ns + round(self.options.period * _NS)
        for name, output in self._states.items():
            if output.wanted:
                output.publish(self._state(name))

    def _state(self, name: str) -> Message:
        model = self.sim.model(name)
        pose, velocity = model.pose, self.sim.link(model.scene.canonical_link).spatial_velocity()
        w, x, y, z = pose.quaternion.tolist()
        back = quat_conjugate(pose.quaternion)
        linear, angular = quat_rotate(back, velocity[3:]), quat_rotate(back, velocity[:3])
        place = {"position": xyz(pose.position), "orientation": {"x": x, "y": y, "z": z, "w": w}}
        return msgs.make(
            _ODOMETRY,
            header=msgs.header(self.sim.time_ns, "world"),
            child_frame_id="base_link",
            pose={"pose": place},
            twist={"twist": {"linear": xyz(linear), "angular": xyz(angular)}},
        )
