"""Underwater vehicle in Gazebo Classic: `libuuv_underwater_object_ros_plugin.so` of uuv_simulator.

Parameters, topics and services are those of `UnderwaterObjectPlugin.cc` and `UnderwaterObjectROSPlugin.cc`. The forces
are those of `simkit_water_and_air.plugins.uuv.hydrodynamic_model`.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, msgs
from simkit.extend import Options, OptionsOf, blocks, boolean, find_link, listens, number, offers, publishes, text
from simkit.linear_algebra import matmul
from simkit.pose import quat_from_rpy
from simkit_water_and_air.plugins.fluids.collision_volumes import link_size
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.water_current import CURRENT_TYPES, VECTOR, absolute_topic, current_of
from simkit_water_and_air.plugins.uuv.hydrodynamic_model import SCALES, SEA_WATER, HydrodynamicModel
from simkit_water_and_air.plugins.uuv.uuv_sensor import TRANSFORMS

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder, Vector
    from simkit.msgs import Message

_SERVICES: Final = "uuv_gazebo_ros_plugins_msgs/srv"
_BOOL, _MARKER, _WRENCH = "std_msgs/msg/Bool", "visualization_msgs/msg/Marker", "geometry_msgs/msg/WrenchStamped"
_CAUSES: Final = ("restoring", "damping", "added_mass", "added_coriolis")
_ARROW_HEIGHT: Final = 1.5  # of the arrow of the current above the model [m]


class WetLinkOptions(Options):
    """Options of a `<link>`; `HydrodynamicModel` reads its elements."""


class UnderwaterObjectOptions(Options):
    """Options of `UnderwaterObject`."""

    fluid_density: float = number(SEA_WATER, "kg/m³", minimum=1e-9, maximum=1e9)
    flow_topic: str = text(element="flow_velocity_topic")
    use_global: bool = boolean(True, element="use_global_current")
    debug: bool = boolean()
    links: tuple[WetLinkOptions, ...] = blocks(WetLinkOptions, element="link")


class UnderwaterObject(ModelPlugin):
    """Lifts and brakes links in water whose surface is at z = 0, with added mass, and moves them with a current.

    The current is that of `<flow_velocity_topic>`, or of `/<model>/current_velocity` if `<use_global_current>` is
    false. Services scale and offset the coefficients. `<debug>` publishes the forces on `/debug/forces/<link>/…`.
    """

    endpoints = (
        listens("/{flow_velocity_topic}", *CURRENT_TYPES, named_by=("flow_velocity_topic",)),
        listens("/{model}/current_velocity", VECTOR),
        publishes("/{model}/is_submerged", _BOOL),
        publishes("/{model}/using_global_current_velocity", _BOOL),
        publishes("/{model}/current_velocity_marker", _MARKER),
        offers("/{model}/set_use_global_current_velocity", f"{_SERVICES}/SetUseGlobalCurrentVel"),
        offers("/{model}/get_model_properties", f"{_SERVICES}/GetModelProperties"),
        *(offers(f"/{{model}}/set_{name}", f"{_SERVICES}/SetFloat") for name in SCALES),
        *(offers(f"/{{model}}/get_{name}", f"{_SERVICES}/GetFloat") for name in SCALES),
    )
    options = OptionsOf(UnderwaterObjectOptions)
    filenames = (
        "libuuv_underwater_object_ros_plugin.so",
        "libuuv_underwater_object_plugin.so",
        "libunderwater_object_ros_plugin.so",
    )
    reads_at_load = ("inertial", "geometry")

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._models: dict[str, HydrodynamicModel] = {}
        for element in params.all("link"):
            name = element.attribute("name")
            link = find_link(scene, name, element)
            if link is not None:
                model = HydrodynamicModel(link, element, options.fluid_density, link_size(link))
                self._models[link.scoped] = model
        bases = [name for name in self._models if "base_link" in name.rsplit("::", 1)[-1]]
        self._base = bases[-1] if bases else next(iter(self._models), "")
        self._inertials = {link.scoped: link.inertial for link in scene.all_links()}

    def load(self, parent: Model, params: Params) -> None:
        options, name = self.options, parent.name
        self._model = parent
        self._links = PushedLinks(self.sim, tuple(self._models))
        self._current, self._is_global = (0.0, 0.0, 0.0), options.use_global
        if options.flow_topic:
            self.listen(absolute_topic(options.flow_topic), CURRENT_TYPES, partial(self._on_current, True))
        self.listen(f"/{name}/current_velocity", VECTOR, partial(self._on_current, False))
        self._submerged = self.advertise(f"/{name}/is_submerged", _BOOL)
        self._use = self.advertise(f"/{name}/using_global_current_velocity", _BOOL)
        self._marker = self.advertise(f"/{name}/current_velocity_marker", _MARKER)
        self._forces = {
            (link, cause): self.advertise(f"/debug/forces/{link.rsplit('::', 1)[-1]}/{cause}", _WRENCH)
            for link in (self._models if options.debug else ())
            for cause in _CAUSES
        }
        self.offer(f"/{name}/set_use_global_current_velocity", f"{_SERVICES}/SetUseGlobalCurrentVel", self._use_global)
        self.offer(f"/{name}/get_model_properties", f"{_SERVICES}/GetModelProperties", self._properties)
        for scale in SCALES:
            self.offer(f"/{name}/set_{scale}", f"{_SERVICES}/SetFloat", partial(self._set_scale, scale))
            self.offer(f"/{name}/get_{scale}", f"{_SERVICES}/GetFloat", partial(self._get_scale, scale))
        self._publish_frame()

    def _publish_frame(self) -> None:
        """Publish the frame of the vehicle whose y and z axes are reversed."""
        w, x, y, z = quat_from_rpy(math.pi, 0.0, 0.0).tolist()
        frame = f"{self._model.name}/base_link"
        rotation = {"x": x, "y": y, "z": z, "w": w}
        transform = {
            "header": msgs.header(self.sim.time_ns, frame),
            "child_frame_id": f"{frame}_ned",
            "transform": {"rotation": rotation},
        }
        output = self.advertise("/tf_static", TRANSFORMS, latched=True)
        output.publish(msgs.make(TRANSFORMS, transforms=[transform]))

    # ------------------------------------------------------------------ commands

    def _on_current(self, is_global: bool, message: Message) -> None:
        if is_global != self._is_global:
            return
        current = current_of(message)
        if current is None:
            self._once.not_finite("a current")
        else:
            self._current = current

    def _use_global(self, request: Message) -> dict[str, object]:
        if bool(request.use_global) != self._is_global:
            self._is_global, self._current = bool(request.use_global), (0.0, 0.0, 0.0)
        return {"success": True}

    def _set_scale(self, name: str, request: Message) -> dict[str, object]:
        value = float(request.data)
        if not math.isfinite(value) or (value < 0 and not name.endswith("_offset")):
            return {"success": False, "message": f"{name} {value:g} is not set; expected a finite number of at least 0"}
        for model in self._models.values():
            model.set_scale(name, value)
        return {"success": True, "message": f"{name} of all links is {value:g}"}

    def _get_scale(self, name: str, _: Message) -> dict[str, object]:
        model = next(iter(self._models.values()), None)
        return {"data": SCALES[name] if model is None else model.scales[name]}

    def _properties(self, _: Message) -> dict[str, object]:
        listed = []
        for name, model in self._models.items():
            inertial = self._inertials[name]
            ixx, iyy, izz, ixy, ixz, iyz = inertial.inertia
            listed.append(
                {
                    "added_mass": model.added.reshape(36),
                    "linear_damping": model.linear.reshape(36),
                    "linear_damping_forward_speed": model.forward.reshape(36),
                    "quadratic_damping": model.quadratic.reshape(36),
                    "volume": model.volume,
                    "bbox_length": float(model.size[0]),
                    "bbox_width": float(model.size[1]),
                    "bbox_height": float(model.size[2]),
                    "fluid_density": model.scales["fluid_density"],
                    "cob": dict(zip("xyz", model.buoyancy_centre.tolist(), strict=True)),
                    "neutrally_buoyant": model.is_neutral,
                    "inertia": {
                        "m": inertial.mass,
                        "com": dict(zip("xyz", map(float, inertial.com), strict=True)),
                        "ixx": ixx,
                        "ixy": ixy,
                        "ixz": ixz,
                        "iyy": iyy,
                        "iyz": iyz,
                        "izz": izz,
                    },
                }
            )
        return {"link_names": [name.rsplit("::", 1)[-1] for name in self._models], "models": listed}

    # ------------------------------------------------------------------ forces

    def before_step(self) -> None:
        """Apply the forces of the water for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, tuple(self._models))
        links = self._links
        if not len(links):
            return
        data = moving_data(self.sim)
        velocities, axes = links.velocities(data), links.axes(data)
        gravity = abs(float(self.sim.mj_model.opt.gravity[2]))
        forces, torques = np.zeros((len(links), 3)), np.zeros((len(links), 3))
        for row, name in enumerate(links.names):
            body, turned = links.ids[row], axes[row]
            relative = velocities[row] - np.array(self._current)
            velocity = np.concatenate((matmul(relative, turned), matmul(data.cvel[body, :3], turned)))
            wrench = self._models[name].wrench(velocity, self.period)
            lift, torque = self._models[name].buoyancy(float(data.xpos[body][2]), turned, gravity)
            arm = data.xpos[body] - data.xipos[body]
            forces[row] = matmul(turned, wrench[:3]) + np.array((0.0, 0.0, lift))
            torques[row] = matmul(turned, wrench[3:]) + torque + np.array((arm[1] * lift, -arm[0] * lift, 0.0))
        links.push(data, forces, torques)

    def after_step(self) -> None:
        """Publish the state of the vehicle, and with `<debug>` the forces."""
        if self._submerged.wanted and self._base:
            self._submerged.publish(msgs.make(_BOOL, data=self._models[self._base].is_submerged))
        if self._use.wanted:
            self._use.publish(msgs.make(_BOOL, data=self._is_global))
        if self._marker.wanted:
            self._marker.publish(self._arrow())
        for (link, cause), output in self._forces.items():
            part = self._models[link].parts.get(cause)
            if output.wanted and part is not None:
                output.publish(_wrench_message(self.sim.time_ns, part))

    def _arrow(self) -> Message:
        x, y, z = self._current
        if not any(self._current):
            return msgs.make(_MARKER, header=msgs.header(0, "world"), ns=self._marker_space, action=2)
        w, i, j, k = quat_from_rpy(0.0, -math.atan2(z, math.hypot(x, y)), math.atan2(y, x)).tolist()
        place = self._model.pose.position.tolist()
        pose = {
            "position": {"x": place[0], "y": place[1], "z": place[2] + _ARROW_HEIGHT},
            "orientation": {"x": i, "y": j, "z": k, "w": w},
        }
        return msgs.make(
            _MARKER,
            header=msgs.header(0, "world"),
            ns=self._marker_space,
            pose=pose,
            scale={"x": 1.0, "y": 0.1, "z": 0.1},
            color={"b": 1.0, "a": 1.0},
        )

    @property
    def _marker_space(self) -> str:
        return f"{self._model.name}/current_velocity_marker"


def _wrench_message(time_ns: int, part: Vector) -> Message:
    force, torque = (dict(zip("xyz", part[i : i + 3].tolist(), strict=True)) for i in (0, 3))
    return msgs.make(_WRENCH, header=msgs.header(time_ns, ""), wrench={"force": force, "torque": torque})
