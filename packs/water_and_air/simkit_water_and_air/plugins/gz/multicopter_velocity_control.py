"""Velocity control of a multicopter: `gz::sim::systems::MulticopterVelocityControl`.

The controller is geometric: T. Lee, M. Leok and N. H. McClamroch, "Control of complex maneuvers for a quadrotor UAV
using geometric methods on SE(3)", 2011. From the error of the velocity it computes the desired force, from this force
the desired attitude, from the errors of attitude and turning rate the desired torques, and from force and torques the
speeds of the rotors. It reads true values of the simulation, with noise on request.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, cast

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import (
    LARGEST,
    Options,
    OptionsOf,
    Vector,
    block,
    blocks,
    choice,
    find_named_joint,
    find_named_link,
    listens,
    number,
    text,
    vector3,
)
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul, norm
from simkit.matrix_decompositions import pinv, svd
from simkit.msgs import valid_topic
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.link_forces import moving_data
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MulticopterMotorModel

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Bool, Twist, TwistStamped

Triple = tuple[float, float, float]
_MOST: Final = (LARGEST, LARGEST, LARGEST)
_PARALLEL: Final = 1e-3  # square of the sine of the largest angle at which two directions count as parallel


class RotorOptions(Options):
    """One rotor of the vehicle."""

    joint: str = text(None, element="jointName", required=True)
    force_constant: float = number(None, "N·s²/rad²", element="forceConstant", minimum=1e-15, required=True)
    moment_constant: float = number(None, "m", element="momentConstant", minimum=0, required=True)
    direction: str = choice(("1", "-1", "+1"), element="direction", required=True)


class RotorConfigurationOptions(Options):
    """All rotors of the vehicle, in the order of the numbers of their motors."""

    rotors: tuple[RotorOptions, ...] = blocks(RotorOptions, element="rotor")


class VelocityControlOptions(Options):
    """Options of `MulticopterVelocityControl`."""

    namespace: str = text(None, element="robotNamespace", required=True)
    command_topic: str = text("cmd_vel", element="commandSubTopic")
    enable_topic: str = text("enable", element="enableSubTopic")
    com_link: str = text(None, element="comLinkName", required=True)
    velocity_gain: Triple = vector3(element="velocityGain", unit="N·s/m", required=True)
    attitude_gain: Triple = vector3(element="attitudeGain", unit="N·m", required=True)
    rate_gain: Triple = vector3(element="angularRateGain", unit="N·m·s", required=True)
    most_acceleration: Triple = vector3(_MOST, "m/s²", element="maximumLinearAcceleration")
    most_linear: Triple = vector3(_MOST, "m/s", element="maximumLinearVelocity")
    most_angular: Triple = vector3(_MOST, "rad/s", element="maximumAngularVelocity")
    linear_noise_mean: Triple = vector3(element="linearVelocityNoiseMean", unit="m/s")
    linear_noise: Triple = vector3(element="linearVelocityNoiseStdDev", unit="m/s")
    angular_noise_mean: Triple = vector3(element="angularVelocityNoiseMean", unit="rad/s")
    angular_noise: Triple = vector3(element="angularVelocityNoiseStdDev", unit="rad/s")
    configuration: RotorConfigurationOptions = block(RotorConfigurationOptions, element="rotorConfiguration")


class MulticopterVelocityControl(ModelPlugin):
    """Flies a multicopter at a commanded linear velocity and turning rate, by the speeds of its rotors.

    Commands are `Twist` messages on `<commandSubTopic>` below `<robotNamespace>`, in the axes of `<comLinkName>`; only
    the linear part and the rate about z count, and each stays active until the next. Before the first command the
    rotors stand still. `false` on `<enableSubTopic>` stops the rotors; `true` waits for a new command. Each rotor needs
    a `MulticopterMotorModel` in the same model, whose `<motorNumber>` is the rotor's place in `<rotorConfiguration>`.
    """

    endpoints = (
        listens("/{robotNamespace}/cmd_vel", *COMMAND_TYPES, named_by=("commandSubTopic",)),
        listens("/{robotNamespace}/enable", "std_msgs/msg/Bool", named_by=("enableSubTopic",)),
    )
    options = OptionsOf(VelocityControlOptions)
    filenames = ("gz-sim-multicopter-control-system",)
    names = ("gz::sim::systems::MulticopterVelocityControl",)
    reads_at_load = ("inertial", "axes")  # mass of the vehicle, places of the rotors

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._link = find_named_link(scene, "comLinkName", params)
        faults = params.diagnostics.error_count
        rows = [row for row in (self._read_rotor(scene, rotor) for rotor in options.configuration.rotors) if row]
        self._mass = float_sum(float(link.inertial.mass) for link in scene.all_links())
        effects = np.array(rows).reshape(-1, 4).T
        sizes = np.linalg.norm(effects, axis=1)  # a Crazyflie's torque at 1 rad/s is only 1e-10 N·m
        if params.diagnostics.error_count > faults:
            return  # rotors that could not be read are reported already
        if not sizes.all() or (svd(effects / sizes[:, np.newaxis])[1] > 1e-6).sum() < 4:
            text = f"<rotorConfiguration> has {len(rows)} rotors that cannot push and turn the vehicle about all axes"
            hint = "list at least four rotors that are not in one line, with both directions"
            params.error("SK-PLUGIN-116", f"{text}", hint)
            return
        self._allocation = pinv(effects)

    def _read_rotor(self, scene: SceneModel, rotor: RotorOptions) -> tuple[float, float, float, float] | None:
        """Return the effects of a rotor at 1 rad/s in the axes of the link: torques [N·m] and thrust [N]."""
        rotor.read_all()
        joint = find_named_joint(scene, "jointName", rotor.params)
        links = {link.scoped: link for link in scene.all_links()}
        if joint is None or self._link not in links:
            return None
        into_link = links[self._link].pose_world.inverse()
        x, y, _ = into_link.transform(joint.pose_world.position)
        axis = into_link.rotate(joint.axes[0].xyz_world)
        thrust = rotor.force_constant * float(axis[2])
        turning = -1 if rotor.direction == "-1" else 1
        return y * thrust, -x * thrust, -turning * thrust * rotor.moment_constant, thrust

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._command: tuple[Triple, float] | None = None
        self._is_enabled, self._is_turning = True, False
        self._noise = {
            name: (np.array(mean), np.array(deviation), self.random(name, 3))
            for name, mean, deviation in (
                ("linear", options.linear_noise_mean, options.linear_noise),
                ("angular", options.angular_noise_mean, options.angular_noise),
            )
            if any(deviation)
        }
        namespace = options.namespace
        self.listen(valid_topic(f"/{namespace}/{options.command_topic}"), COMMAND_TYPES, self._on_command)
        self.listen(valid_topic(f"/{namespace}/{options.enable_topic}"), "std_msgs/msg/Bool", self._on_enable)

    def _on_command(self, message: Twist | TwistStamped) -> None:
        twist = cast("Twist", getattr(message, "twist", message))
        values = [float(v) for v in (twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z)]
        if not are_usable(*values):
            self._once.not_finite()
            return
        (x, y, z), most = self.options.most_linear, abs(self.options.most_angular[2])
        a, b, c = (max(-abs(m), min(abs(m), v)) for v, m in zip(values, (x, y, z), strict=False))
        self._command = (a, b, c), max(-most, min(most, values[3]))

    def _on_enable(self, message: Bool) -> None:
        self._is_enabled = bool(message.data)

    def before_step(self) -> None:
        """Set the speeds of the rotors for the next step."""
        if not self._is_enabled:
            self._command = None
            if self._is_turning:
                self._is_turning = False
                self._send([0.0] * self._allocation.shape[0])
            return
        if self._command is not None:
            self._is_turning = True
            self._send(self._rotor_speeds(*self._command).tolist())

    def _send(self, speeds: list[float]) -> None:
        for motor in self.sim.engine.names.shared(f"motors {id(self)}", self._find_motors):
            if motor.motor_number < len(speeds):
                motor.command(speeds[motor.motor_number])

    def _find_motors(self) -> list[MulticopterMotorModel]:
        plugins = self.sim.engine.structure.all_plugins()
        return [p for p in plugins if isinstance(p, MulticopterMotorModel) and p.scoped == self.scoped]

    def _rotor_speeds(self, linear: Triple, rate: float) -> Vector:
        """Return the speeds of the rotors [rad/s], shape (n,).

        Args:
            linear: desired velocity in the link's axes [m/s].
            rate: desired turning rate about z [rad/s].
        """
        options, data = self.options, moving_data(self.sim)
        body = self.sim.engine.names.links[self._link].body
        axes: Vector = data.xmat[body].reshape(3, 3)
        spin, motion = data.cvel[body, :3], data.cvel[body, 3:]
        root = self.sim.mj_model.body_rootid[body]
        velocity = self._with_noise("linear", motion + np.cross(spin, data.xpos[body] - data.subtree_com[root]))
        turning = self._with_noise("angular", matmul(axes.T, spin))
        asked = (velocity - matmul(axes, linear)) * options.velocity_gain / self._mass
        most = np.abs(options.most_acceleration)
        force = np.clip(asked, -most, most) + self.sim.mj_model.opt.gravity  # points down
        aim = _attitude(axes, -force)
        skew = 0.5 * (matmul(aim.T, axes) - matmul(axes.T, aim))
        angle = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
        lag = turning - matmul(axes.T, aim[:, 2]) * rate
        torques = -angle * options.attitude_gain - lag * options.rate_gain
        thrust = -self._mass * float(matmul(force, axes[:, 2]))
        squared: Vector = matmul(self._allocation, np.append(torques, thrust))
        return np.sqrt(np.maximum(squared, 0.0))

    def _with_noise(self, name: str, value: Vector) -> Vector:
        if name not in self._noise:
            return value
        mean, deviation, stream = self._noise[name]
        drawn = np.asarray(stream.normal(self.sim.tick)) * deviation + mean
        return value + np.where(deviation > 0, drawn, 0.0)


def _attitude(axes: Vector, upward: Vector) -> Vector:
    """Return the rotation matrix whose z axis is `upward` and whose x axis is closest to that of `axes`."""
    length = norm(upward)
    z = upward / length if length > 0 else axes[:, 2]
    x = next((a for a in axes.T if float(np.sum(np.cross(a, z) ** 2)) >= _PARALLEL), axes[:, 0])
    y = np.cross(z, x)
    y /= norm(y)
    return np.column_stack([np.cross(y, z), y, z])
