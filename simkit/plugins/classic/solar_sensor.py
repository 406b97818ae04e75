"""Solar sensor of the robotics course: `libsolar_sensor.so`, a model plugin that measures the direction of a light."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit import msgs
from simkit.diagnostics import NOWHERE, did_you_mean
from simkit.linear_algebra import matmul
from simkit.params import LARGEST, Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import publishes
from simkit.plugins.find_entities import find_link
from simkit.plugins.options import Options, OptionsOf, block, boolean, choice, number, text, vector3, without_effect
from simkit.pose import Pose, Vector, quat_conjugate, quat_from_rpy, quat_multiply, quat_rotate, quat_to_matrix
from simkit.sensors.environment import solar_irradiance
from simkit.sensors.environment.solar_irradiance import SolarReading, SolarView

if TYPE_CHECKING:
    from simkit.compiler import Compiled, SpecBuilder
    from simkit.runtime import Light, Model
    from simkit.runtime.communication.publisher import Publisher
    from simkit.scene import SceneModel

IMU = "sensor_msgs/msg/Imu"
_TYPES = IMU, "geometry_msgs/msg/Quaternion", "geometry_msgs/msg/Vector3"
_NONE = np.zeros(9)


class SolarSensorPanelOptions(Options):
    """Options in the `<panel>` block."""

    area: float = number(minimum=0.0, maximum=1e100, required=True)
    efficiency: float = number(minimum=0.0, maximum=1.0, required=True)
    normal: tuple[float, float, float] = vector3((0.0, 0.0, 1.0))


class SolarSensorOptions(Options):
    """Options of `SolarSensor`."""

    frame_name: str = text()
    body_name: str = text()
    xyz_offsets: tuple[float, float, float] = vector3(unit="m")
    xyz_offset: tuple[float, float, float] = vector3(unit="m")
    rpy_offsets: bool = without_effect()
    rpy_offset: bool = without_effect()
    rotation: tuple[float, float, float] = vector3(unit="rad")
    gaussian_noise: float = number(0.0, minimum=0, maximum=LARGEST)
    rpy_noise: float = number(0.0, minimum=0, maximum=LARGEST)
    angular_noise: float = number(0.0, minimum=0, maximum=LARGEST)
    normal: tuple[float, float, float] = vector3((0.0, 0.0, 1.0))
    irradiance: str = text()
    panel: SolarSensorPanelOptions = block(SolarSensorPanelOptions)
    shadow: bool = boolean()
    towards: str = choice(("direction", "position"), "position")
    falloff: str = choice(("none", "inverse_square", "attenuation"), "none")
    field_of_view: float = number(6.283185307179586, minimum=0.0, maximum=6.283185308179586)
    update_rate: float = number(0.0, "Hz", minimum=0)
    light_name: str = text()


class SolarSensor(ModelPlugin):
    """Publishes the direction of a light, seen from a link, as the orientation of an `Imu` on `sunloin_imu`.

    Let (x, y, z) be the unit vector from the link's origin to the light, in the link's axes, plus `<xyz_offset>`. The
    orientation has pitch = asin(-z) and yaw = atan2(y, x), so its x axis points at the light. The course's listing
    reads `<rpy_offset>` and does not use it for the message, so it has no effect here either. A missing light is a
    warning and a line of the log, as in the listing: the sensor publishes nothing, and the world runs.

    `<frame_name>` is the message's frame and also names the link. If the link has another name, write that name into
    `<body_name>`. The default is the model's canonical link. The square of `<gaussian_noise>` [rad] is on the diagonal
    of the covariance; the orientation itself has no noise. `<update_rate>` is in Hz; 0 means every step.

    simkit adds options, which are all off by default. `<simkit:shadow>`, `<simkit:field_of_view>`,
    `<simkit:irradiance>`, `<simkit:panel>`, `<simkit:falloff>` and `<simkit:normal>` have the same meaning as in the
    `solar_irradiance` sensor; their readings are on topics below `sunloin_imu`. `<simkit:rpy_noise>` [rad] is the
    standard deviation of independent noise on roll, pitch and yaw, and `<simkit:angular_noise>` [rad] turns the
    direction about a random perpendicular axis; both add their variance to the covariance. `<simkit:rotation>` [rad]
    turns the orientation by roll, pitch and yaw. If `<simkit:towards>` is `direction`, the rays of a directional
    light are parallel.
    """

    endpoints = (
        publishes("sunloin_imu", IMU),
        publishes("sunloin_imu/valid", "std_msgs/msg/Bool"),
        publishes("sunloin_imu/irradiance", "std_msgs/msg/Float64"),
        publishes("sunloin_imu/power", "std_msgs/msg/Float64"),
        publishes("sunloin_imu/shadow", "std_msgs/msg/String"),
    )
    options = OptionsOf(SolarSensorOptions)
    filenames = ("libsolar_sensor.so",)
    only_publishes = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        frame, body = self.options.frame_name, self.options.body_name
        name = body or frame
        link = find_link(scene, name, params) if name else None
        self._link_name = link.scoped if link else scene.canonical_link
        self._frame = frame or self._link_name.rsplit("::", 1)[-1]
        self._xyz = _offset(params)
        self._rpy = self.options.rotation
        self._noise = self.options.rpy_noise
        self._angular = self.options.angular_noise
        self._options = solar_irradiance.read_solar_options(params, "position")
        self.after_step_rate = self.options.update_rate

    def load(self, parent: Model, params: Params) -> None:
        for name in ("rpy_offset", "rpy_offsets"):
            if (child := params.child(name)) is not None:
                message = f"<{name}> has no effect: the plugin of the course does not use it for the message"
                params.diagnostics.note(
                    "SK-PLUGIN-095", message, child.where, "<simkit:rotation> turns the orientation"
                )
        self._light = self._find_light(params)
        self._link = self.sim.link(self._link_name)
        self._turn = quat_from_rpy(*self._rpy)
        self._turn_matrix = quat_to_matrix(self._turn)
        self._covariance = np.eye(3).reshape(9) * (self.options.gaussian_noise**2 + self._noise**2)
        self._stream = self.random("gaussian_noise", 3) if self._noise > 0 else None
        self._angular_stream = self.random("angular_noise", 2) if self._angular > 0 else None
        self._index = 0
        self._readings = self.advertise("sunloin_imu", IMU)
        self._create_view(params)

    def _find_light(self, params: Params) -> Light | None:
        """Return the light that `<light_name>` names; None after a diagnostic and a line of the log."""
        sim, name = self.sim, self.options.light_name
        lights = sim.contents.lights
        if name in lights:
            return lights[name]
        if name and not lights and sim.world.where == NOWHERE:
            message = f"a model without a world has no light {name!r}; nothing is published until a world has it"
            params.diagnostics.note("SK-PLUGIN-009", message, params.where)
            return None
        listed = ", ".join(repr(n) for n in sorted(lights)) or "none"
        problem = f"there is no light {name!r}" if name else f"<{params.name}> has no <light_name>"
        message = f"plugin {self.name!r}: {problem}; this sensor publishes nothing; the lights are: {listed}"
        params.warning("SK-PLUGIN-094", message, did_you_mean(name, lights))
        self.log.error(message)
        return None

    def _create_view(self, params: Params) -> None:
        """Create the view of the light, and open the topics of the options that the file enables."""
        options = self._options
        judges = options.shadow or params.has("field_of_view")
        self._view: SolarView | None = None
        self._compiled: Compiled | None = None
        self._more: list[tuple[Publisher, str, Callable[[SolarReading], object]]] = []
        if self._light is None:
            return
        solar_irradiance.report_unused_options(params, options, self._light)
        if judges or options.measures_irradiance:
            self._view = SolarView(options, self._light)
        number, topic = "std_msgs/msg/Float64", self.ros.topic("sunloin_imu")
        for name, kind, is_enabled, value in (
            ("valid", "std_msgs/msg/Bool", judges, lambda r: r.is_valid),
            ("irradiance", number, options.measures_irradiance, lambda r: r.irradiance),
            ("power", number, options.panel is not None, lambda r: r.power),
            ("shadow", "std_msgs/msg/String", options.shadow, lambda r: r.shadow),
        ):
            if is_enabled:
                self._more.append((self.advertise(f"{topic}/{name}", kind), kind, value))

    def after_step(self) -> None:
        self._index += 1  # counted even without subscribers, because the noise depends on this number
        if self._light is None:
            return
        if self._view is not None:
            self._look(self._view, self._light)
        elif self._readings.wanted:
            self._publish(self._link.pose, self._light.pose, True)

    def _look(self, view: SolarView, light: Light) -> None:
        subscribed = [endpoint for endpoint in self._more if endpoint[0].wanted]
        if not (subscribed or self._readings.wanted):
            return
        sim, pose = self.sim, self._link.pose
        if self._compiled is not sim.engine.compiled:  # the structure changed
            self._compiled = sim.engine.compiled
            view.bind(self._compiled, self._link_name)
        reading = view.measure(sim.mj_model, sim.engine.physics.fresh(), light.state, pose.position, pose.matrix)
        for publisher, kind, value in subscribed:
            publisher.publish(msgs.type_of(kind)(value(reading)))
        if self._readings.wanted:
            self._publish(pose, light.pose, reading.is_valid)

    def _publish(self, pose: Pose, light: Pose, is_valid: bool) -> None:
        time_ns, index = self.sim.time_ns, self._index
        self._readings.publish_later(partial(self._message, time_ns, index, pose, light, is_valid))

    def _message(self, time_ns: int, index: int, pose: Pose, light: Pose, is_valid: bool) -> object:
        imu, quaternion, vector = msgs.types_of(*_TYPES)
        orientation, covariance = np.array((1.0, 0.0, 0.0, 0.0)), np.zeros(9)
        if is_valid:
            orientation, covariance = self._measured(index, pose, light)
        else:
            covariance[0] = -1.0
        w, x, y, z = orientation.tolist()
        header = msgs.header(time_ns, self._frame)
        rest = covariance, vector(0.0, 0.0, 0.0), _NONE.copy(), vector(0.0, 0.0, 0.0), _NONE.copy()
        return imu(header, quaternion(x, y, z, w), *rest)

    def _measured(self, index: int, pose: Pose, light: Pose) -> tuple[Vector, Vector]:
        """Return the orientation (w, x, y, z) with its noise, and its covariance, shape (9,)."""
        roll, (pitch, yaw) = 0.0, self._angles(pose, light)
        covariance = self._covariance.copy()
        if self._stream is not None:
            roll, pitch, yaw = (np.array((roll, pitch, yaw)) + self._noise * self._stream.normal(index)).tolist()
        orientation = quat_from_rpy(roll, pitch, yaw)
        if self._angular_stream is not None:
            orientation = solar_irradiance.deflect_orientation(
                orientation, self._angular * self._angular_stream.normal(index)
            )
            covariance += solar_irradiance.covariance_across(
                quat_rotate(orientation, (1.0, 0.0, 0.0)), self._angular**2
            )
        if any(self._rpy):
            orientation = quat_multiply(self._turn, orientation)
            turned = matmul(self._turn_matrix, covariance.reshape(3, 3), self._turn_matrix.T)
            covariance = turned.reshape(9) if self._angular > 0 else covariance
        return orientation, covariance

    def _angles(self, pose: Pose, light: Pose) -> tuple[float, float]:
        """Return pitch and yaw [rad] of the light in the link's axes."""
        assert self._light is not None
        is_parallel = self._options.towards == "direction" and self._light.scene.type == "directional"
        towards = -light.rotate(self._light.scene.direction) if is_parallel else light.position - pose.position
        distance = math.sqrt(matmul(towards, towards))
        seen = quat_rotate(quat_conjugate(pose.quaternion), towards / distance if distance > 0 else towards)
        x, y, z = (a + b for a, b in zip(seen.tolist(), self._xyz, strict=True))
        return math.asin(-max(-1.0, min(1.0, z))), math.atan2(y, x)


def _offset(params: Params) -> tuple[float, float, float]:
    """Read the numbers of `<xyz_offset>`; the old spelling, with an s at the end, causes a warning."""
    older = params.child("xyz_offsets")
    if older is None or params.has("xyz_offset"):
        return params.vector3("xyz_offset", (0.0, 0.0, 0.0))
    params.diagnostics.warning("SK-PARAM-004", f"<{older.name}> is an old spelling", older.where, "write <xyz_offset>")
    return params.vector3("xyz_offsets", (0.0, 0.0, 0.0))
