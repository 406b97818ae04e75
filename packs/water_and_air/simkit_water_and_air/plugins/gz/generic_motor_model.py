"""Motor with a polynomial for its thrust: PX4's `libGenericMotorModelPlugin.so`.

Parameters and formulas are those of `GenericMotorModel.cpp` of PX4-Autopilot. With `<motorType>force_polynomial`, the
thrust is Σ cᵢ·|x|ⁱ along the z axis of the link, for the command x: a speed, or a duty cycle scaled to -1…1 or 0…1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import OptionsOf, choice, integer, listens, number, text
from simkit.number_text import number_or_nan
from simkit.plugins.joints.joint_commands import ACTUATORS
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MotorModelOptions, MulticopterMotorModel

if TYPE_CHECKING:
    from simkit.extend import SceneModel, SpecBuilder

_TYPES: Final = ("velocity", "position", "force", "force_polynomial")
_POLYNOMIALS: Final = (
    "positiveThrustPolynomial",
    "negativeThrustPolynomial",
    "positiveTorquePolynomial",
    "negativeTorquePolynomial",
)


class GenericMotorOptions(MotorModelOptions):
    """Options of `GenericMotorModel`."""

    motor_type: str = choice(_TYPES, "velocity", element="motorType")
    control_method: str = choice(("rpm", "duty_cycle"), "rpm", element="controlMethod")
    least_command: float = number(0.0, element="minCommand", minimum=0.0)
    low_duty: float = number(0.0, "µs", element="minDutyCycle")
    high_duty: float = number(0.0, "µs", element="maxDutyCycle")
    bidirectional: int = integer(0, element="bidirectionalMotor", minimum=0, maximum=1)
    positive_thrust: str = text(element=_POLYNOMIALS[0])
    negative_thrust: str = text(element=_POLYNOMIALS[1])
    positive_torque: str = text(element=_POLYNOMIALS[2])
    negative_torque: str = text(element=_POLYNOMIALS[3])


class GenericMotorModel(MulticopterMotorModel):
    """Turns one rotor or thruster at a commanded speed or duty cycle, and applies its thrust.

    The command is number `<motorNumber>` of an `Actuators` message on `<commandSubTopic>` below `<robotNamespace>`.
    `<motorType>velocity` is `MulticopterMotorModel`; with `force_polynomial`, polynomials give the thrust. A duty cycle
    between `<minDutyCycle>` and `<maxDutyCycle>` [µs] becomes 0…1, or -1…1 with `<bidirectionalMotor>`.
    """

    endpoints = (listens("/{model}/command/motor_speed", ACTUATORS, named_by=("commandSubTopic",)),)
    options = OptionsOf(GenericMotorOptions)
    filenames = ("libGenericMotorModelPlugin.so",)
    names = ("gz::sim::systems::GenericMotorModel",)
    driven_types = ("velocity", "force_polynomial")

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        options = self.options
        self._is_polynomial = options.motor_type == "force_polynomial"
        if not self._is_polynomial:
            return
        if options.control_method == "duty_cycle" and options.low_duty >= options.high_duty:
            message = f"found <minDutyCycle> {options.low_duty:g} and <maxDutyCycle> {options.high_duty:g}"
            params.error("SK-PARAM-002", f"{message}; expected min < max")
        written = options.positive_thrust, options.negative_thrust, options.positive_torque, options.negative_torque
        thrust, back_thrust, torque, back_torque = (
            _parse_polynomial(text, params.block(name)) for name, text in zip(_POLYNOMIALS, written, strict=True)
        )
        if not thrust:
            params.error("SK-PARAM-001", "found no <positiveThrustPolynomial>, which the thrust follows")
        self._polynomials = {+1: (thrust, torque), -1: (back_thrust or thrust, back_torque or torque)}

    def command(self, speed: float) -> None:
        """Set the command from the next step on: a speed [rad/s], or a duty cycle [µs]."""
        options = self.options
        if self._is_polynomial and options.control_method == "duty_cycle":
            if speed < options.low_duty:
                self._input = speed  # as in the source
                return
            span = options.high_duty - options.low_duty
            half = span * options.bidirectional / 2.0
            speed = (speed - options.low_duty - half) / (span - half)
            self._input = speed
            return
        super().command(speed)

    def before_step(self) -> None:
        """Apply the thrust, and turn the rotor."""
        if not self._is_polynomial:
            super().before_step()
            return
        value = self.share * self._input
        self._joint.turn(value / self.options.slowdown)
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link, self._parent))
        links, least = self._links, self.options.least_command
        sign = 1 if value >= least else -1 if value <= -least else 0
        if not sign or not links.names or links.names[0] != self._link:
            return
        thrust = 0.0
        for polynomial in self._polynomials[sign]:  # the source applies the torque as a force, too
            for power, factor in enumerate(polynomial):
                thrust += sign * factor * abs(value) ** power
        data = moving_data(self.sim)
        _, _, x, _, _, y, _, _, z = data.xmat[links.ids[0]].tolist()
        links.push_some(data, {0: (x * thrust, y * thrust, z * thrust, 0.0, 0.0, 0.0)})


def _parse_polynomial(written: str, element: Params) -> tuple[float, ...]:
    """Return the coefficients in a text such as `[0.0, 2.4, 149]`; none for an empty text or after an error."""
    values = tuple(number_or_nan(word) for word in written.strip(" []").replace(",", " ").split())
    if all(abs(value) <= 1e9 for value in values):
        return values
    element.error("SK-PARAM-002", f"found <{element.name}>{written}</{element.name}>; expected numbers")
    return ()
